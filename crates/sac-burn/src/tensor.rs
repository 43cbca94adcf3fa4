//! The border between host slices and burn's tensors: no copy in either direction while one owner holds the data.

use burn::tensor::{Device, Tensor, TensorData};

/// Stack of matrices: [member, row, column].
pub(crate) type Matrices = Tensor<3>;

/// Host numbers as matrices on the Flex backend, named because burn's default depends on features. No copy.
pub(crate) fn matrices(values: Vec<f32>, shape: [usize; 3]) -> Matrices {
    Matrices::from_data(TensorData::new(values, shape), &Device::flex())
}

/// Numbers of a stack of matrices while the host works on them.
#[derive(Debug)]
pub(crate) struct Host {
    data: TensorData,
}

impl Host {
    /// Takes the numbers out of a tensor; copies only if another handle shares them or it is a transposed view.
    pub(crate) fn take(matrices: Matrices) -> Self {
        Self { data: matrices.into_data() }
    }

    /// Row-major numbers.
    pub(crate) fn values(&self) -> &[f32] {
        self.data.as_slice().expect("every tensor here is made from f32")
    }

    /// Row-major numbers, to change.
    pub(crate) fn values_mut(&mut self) -> &mut [f32] {
        self.data.as_mut_slice().expect("every tensor here is made from f32")
    }

    /// Hands the numbers back to burn. No copy.
    pub(crate) fn give(self) -> Matrices {
        Matrices::from_data(self.data, &Device::flex())
    }
}
