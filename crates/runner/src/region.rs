//! The curriculum's regions: polygons in the crane's plane, each inside the next.

use serde::{Deserialize, Serialize};

/// A point (x, z) of the crane's plane \[m\].
pub type Point = (f64, f64);

/// A simple polygon in the crane's plane, vertices in order, closed by itself.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Vec<Point>", into = "Vec<Point>")]
pub struct Polygon(Vec<Point>);

/// Why a list of points is no region.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RegionError {
    /// Fewer than three vertices.
    #[error("a region needs at least 3 vertices, got {0}")]
    TooFewVertices(usize),
    /// A coordinate is NaN or infinite.
    #[error("vertex {index} is ({x}, {z}); both coordinates must be finite")]
    NotFinite {
        /// Position in the list.
        index: usize,
        /// Horizontal coordinate.
        x: f64,
        /// Vertical coordinate.
        z: f64,
    },
    /// Two edges cross.
    #[error("edges {first} and {second} cross; a region must not intersect itself")]
    SelfIntersecting {
        /// Index of the first edge's first vertex.
        first: usize,
        /// Index of the second edge's first vertex.
        second: usize,
    },
    /// A region of the curriculum is not inside the next.
    #[error("{inner} is not inside {outer}: every region must lie within the next one")]
    NotNested {
        /// The region that should be the smaller.
        inner: &'static str,
        /// The region that should contain it.
        outer: &'static str,
    },
    /// The file was written for another version of this program.
    #[error("schema is {0}, this program reads schema 1")]
    Schema(u32),
}

impl TryFrom<Vec<Point>> for Polygon {
    type Error = RegionError;

    fn try_from(vertices: Vec<Point>) -> Result<Self, RegionError> {
        if vertices.len() < 3 {
            return Err(RegionError::TooFewVertices(vertices.len()));
        }
        if let Some((index, &(x, z))) =
            vertices.iter().enumerate().find(|(_, (x, z))| !(x.is_finite() && z.is_finite()))
        {
            return Err(RegionError::NotFinite { index, x, z });
        }
        let polygon = Self(vertices);
        let n = polygon.0.len();
        for first in 0..n {
            for second in first + 2..n {
                let neighbours = first == 0 && second == n - 1;
                if !neighbours && segments_cross(polygon.edge(first), polygon.edge(second)) {
                    return Err(RegionError::SelfIntersecting { first, second });
                }
            }
        }
        Ok(polygon)
    }
}

impl From<Polygon> for Vec<Point> {
    fn from(polygon: Polygon) -> Self {
        polygon.0
    }
}

impl Polygon {
    /// The vertices in order.
    #[must_use]
    pub fn vertices(&self) -> &[Point] {
        &self.0
    }

    fn edge(&self, index: usize) -> (Point, Point) {
        (self.0[index], self.0[(index + 1) % self.0.len()])
    }

    fn edges(&self) -> impl Iterator<Item = (Point, Point)> {
        (0..self.0.len()).map(|index| self.edge(index))
    }

    /// True if the point lies inside (even-odd rule; the boundary may count either way).
    #[must_use]
    pub fn contains(&self, (x, z): Point) -> bool {
        let crossings = self
            .edges()
            .filter(|&((x1, z1), (x2, z2))| (z1 > z) != (z2 > z) && x < x1 + (z - z1) / (z2 - z1) * (x2 - x1))
            .count();
        crossings % 2 == 1
    }

    /// True if the whole of `inner` lies inside: one vertex does, and no edges cross.
    #[must_use]
    pub fn encloses(&self, inner: &Self) -> bool {
        inner.0.iter().all(|&vertex| self.contains(vertex))
            && !self.edges().any(|mine| inner.edges().any(|theirs| segments_cross(mine, theirs)))
    }
}

/// True if the open segments have a point in common.
fn segments_cross((a, b): (Point, Point), (c, d): (Point, Point)) -> bool {
    let side = |p: Point, q: Point, r: Point| (q.0 - p.0) * (r.1 - p.1) - (q.1 - p.1) * (r.0 - p.0);
    side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
}

/// The regions as written down; not yet checked for nesting.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RegionsSpec {
    /// Version of the file's format.
    pub schema: u32,
    /// The first stage.
    pub purple: Polygon,
    /// The second stage.
    pub yellow: Polygon,
    /// The last stage: the target area of the final operation.
    pub orange: Polygon,
    /// What the tip can reach (the paper's blue region).
    pub workspace: Polygon,
}

/// The regions of the curriculum. Invariant: purple ⊂ yellow ⊂ orange ⊂ workspace.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "RegionsSpec", into = "RegionsSpec")]
pub struct Regions(RegionsSpec);

impl TryFrom<RegionsSpec> for Regions {
    type Error = RegionError;

    fn try_from(spec: RegionsSpec) -> Result<Self, RegionError> {
        if spec.schema != 1 {
            return Err(RegionError::Schema(spec.schema));
        }
        let nested = [
            ("purple", &spec.purple),
            ("yellow", &spec.yellow),
            ("orange", &spec.orange),
            ("workspace", &spec.workspace),
        ];
        for pair in nested.windows(2) {
            let [(inner, small), (outer, large)] = [pair[0], pair[1]];
            if !large.encloses(small) {
                return Err(RegionError::NotNested { inner, outer });
            }
        }
        Ok(Self(spec))
    }
}

impl From<Regions> for RegionsSpec {
    fn from(regions: Regions) -> Self {
        regions.0
    }
}

impl Regions {
    /// The region of a stage.
    #[must_use]
    pub fn of(&self, stage: crate::stage::Stage) -> &Polygon {
        match stage {
            crate::stage::Stage::Purple => &self.0.purple,
            crate::stage::Stage::Yellow => &self.0.yellow,
            crate::stage::Stage::Orange => &self.0.orange,
        }
    }

    /// What the tip can reach.
    #[must_use]
    pub fn workspace(&self) -> &Polygon {
        &self.0.workspace
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(x: f64, z: f64, half: f64) -> Polygon {
        Polygon::try_from(vec![
            (x - half, z - half),
            (x + half, z - half),
            (x + half, z + half),
            (x - half, z + half),
        ])
        .unwrap()
    }

    #[test]
    fn a_point_is_inside_a_concave_region_only_where_the_region_is() {
        let notch =
            Polygon::try_from(vec![(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (2.0, 1.0), (0.0, 4.0)]).unwrap();
        assert!(notch.contains((1.0, 1.0)) && notch.contains((3.0, 1.0)));
        assert!(!notch.contains((2.0, 2.0)) && !notch.contains((5.0, 1.0)));
    }

    #[test]
    fn enclosing_is_more_than_vertices_inside() {
        let notch =
            Polygon::try_from(vec![(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (2.0, 1.0), (0.0, 4.0)]).unwrap();
        let bridge = Polygon::try_from(vec![(0.3, 2.5), (0.3, 2.0), (3.7, 2.0), (3.7, 2.5)]).unwrap();
        assert!(bridge.vertices().iter().all(|&v| notch.contains(v)));
        assert!(!notch.encloses(&bridge), "the notch cuts through the bridge");
        assert!(square(0.0, 0.0, 2.0).encloses(&square(0.0, 0.0, 1.0)));
        assert!(!square(0.0, 0.0, 1.0).encloses(&square(0.0, 0.0, 2.0)));
    }

    #[test]
    fn refuses_regions_that_are_none() {
        assert_eq!(Polygon::try_from(vec![(0.0, 0.0), (1.0, 1.0)]), Err(RegionError::TooFewVertices(2)));
        assert!(matches!(
            Polygon::try_from(vec![(0.0, 0.0), (1.0, f64::NAN), (1.0, 1.0)]),
            Err(RegionError::NotFinite { index: 1, .. })
        ));
        assert!(matches!(
            Polygon::try_from(vec![(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)]),
            Err(RegionError::SelfIntersecting { .. })
        ));
    }

    #[test]
    fn refuses_regions_that_are_not_nested() {
        let spec = RegionsSpec {
            schema: 1,
            purple: square(0.0, 0.0, 1.0),
            yellow: square(0.5, 0.0, 1.0),
            orange: square(0.0, 0.0, 3.0),
            workspace: square(0.0, 0.0, 4.0),
        };
        let error = Regions::try_from(spec).unwrap_err();
        assert_eq!(error, RegionError::NotNested { inner: "purple", outer: "yellow" });
    }
}
