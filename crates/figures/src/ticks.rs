//! Where an axis has ticks, and what stands beside them.

/// Ticks of an axis.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Ticks {
    /// Value and label of each.
    pub(crate) marks: Vec<(f64, String)>,
    /// Power of ten by which the labels are to be multiplied.
    pub(crate) exponent: i32,
}

/// Round numbers from `min` to `max`, about `wanted` of them and three at least.
///
/// The steps are 1, 2, 2.5 or 5 times a power of ten. Very large and very small numbers share one power of ten.
pub(crate) fn linear(min: f64, max: f64, wanted: usize) -> Ticks {
    let fewest = wanted.max(1);
    let mut ticks = with_steps(min, max, fewest);
    for steps in fewest + 1..fewest + 8 {
        if ticks.marks.len() >= 3 {
            break;
        }
        ticks = with_steps(min, max, steps);
    }
    ticks
}

fn with_steps(min: f64, max: f64, steps: usize) -> Ticks {
    let (step, decimals) = step((max - min) / steps as f64);
    let magnitude = min.abs().max(max.abs()).log10().floor() as i32;
    let exponent = if (-3..5).contains(&magnitude) { 0 } else { magnitude.div_euclid(3) * 3 };
    let decimals = (decimals + exponent).max(0) as usize;
    let (first, last) = ((min / step - 1e-6).ceil(), (max / step + 1e-6).floor());
    let mut marks = Vec::new();
    let mut index = first;
    while index <= last && marks.len() < 64 {
        let value = index * step;
        marks.push((value, fixed(value / 10f64.powi(exponent), decimals)));
        index += 1.0;
    }
    Ticks { marks, exponent }
}

/// Powers of ten from `min` to `max`, both > 0; with 2 and 5 between them where there are few.
pub(crate) fn logarithmic(min: f64, max: f64, wanted: usize) -> Ticks {
    let (first, last) = (min.log10().floor() as i32, max.log10().ceil() as i32);
    let decades = max.log10() - min.log10();
    let every = (decades / wanted.max(1) as f64).ceil().max(1.0) as i32;
    let between: &[f64] = if decades * 3.0 <= wanted as f64 { &[1.0, 2.0, 5.0] } else { &[1.0] };
    let powers = (first..=last).filter(|power| power.rem_euclid(every) == 0);
    let values = powers.flat_map(|power| between.iter().map(move |&digit| (digit, power)));
    let inside = values
        .map(|(digit, power)| (digit * 10f64.powi(power), power))
        .filter(|(value, _)| (min * (1.0 - 1e-9)..=max * (1.0 + 1e-9)).contains(value));
    let inside: Vec<(f64, i32)> = inside.collect();
    let is_plain = inside.iter().all(|(_, power)| (-3..4).contains(power));
    let marks = inside
        .into_iter()
        .map(|(value, power)| {
            let label = if is_plain {
                fixed(value, (-power).max(0) as usize)
            } else {
                let digit = (value / 10f64.powi(power)).round();
                let factor = if digit > 1.0 { format!("{digit}·") } else { String::new() };
                format!("{factor}10{}", superscript(power))
            };
            (value, label)
        })
        .collect();
    Ticks { marks, exponent: 0 }
}

/// The round step next to `raw`, and the decimals that it needs.
fn step(raw: f64) -> (f64, i32) {
    let power = raw.log10().floor() as i32;
    let unit = 10f64.powi(power);
    let (digit, decimals) = match raw / unit {
        part if part < 1.5 => (1.0, -power),
        part if part < 2.2 => (2.0, -power),
        part if part < 3.5 => (2.5, 1 - power),
        part if part < 7.5 => (5.0, -power),
        _ => (10.0, -power - 1),
    };
    (digit * unit, decimals)
}

/// Fixed decimals with a true minus sign, and no minus before zero.
pub(crate) fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{:.decimals$}", value.abs());
    let is_zero = text.chars().all(|c| c == '0' || c == '.');
    if value < 0.0 && !is_zero { format!("−{text}") } else { text }
}

/// A whole number in superscript.
pub(crate) fn superscript(number: i32) -> String {
    let raised = |c: char| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        digit => char::from_u32('⁰' as u32 + u32::from(digit as u8 - b'0')).unwrap_or(digit),
    };
    number.to_string().chars().map(raised).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(ticks: &Ticks) -> Vec<&str> {
        ticks.marks.iter().map(|(_, label)| label.as_str()).collect()
    }

    #[test]
    fn steps_are_round_and_labels_as_short_as_they_can_be() {
        assert_eq!(labels(&linear(0.0, 1.0, 5)), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(labels(&linear(-0.15, 0.15, 3)), ["−0.1", "0.0", "0.1"]);
        assert_eq!(labels(&linear(3.0, 17.0, 4)), ["5", "10", "15"]);
        assert_eq!(labels(&linear(0.0, 1.0, 4)), ["0.00", "0.25", "0.50", "0.75", "1.00"]);
    }

    #[test]
    fn a_short_axis_has_three_ticks_at_least() {
        assert_eq!(labels(&linear(-0.165, 0.165, 2)), ["−0.1", "0.0", "0.1"]);
    }

    #[test]
    fn small_and_large_numbers_share_a_power_of_ten() {
        let small = linear(-2.2e-5, 4e-5, 4);
        assert_eq!((labels(&small), small.exponent), (vec!["−20", "0", "20", "40"], -6));
        let large = linear(0.0, 3e6, 3);
        assert_eq!((labels(&large), large.exponent), (vec!["0", "1", "2", "3"], 6));
    }

    #[test]
    fn extreme_ranges_end() {
        for (min, max) in [(0.0, f64::MAX / 4.0), (-1e-300, 1e-300), (1e15, 1e15 + 16.0), (0.0, 1e-303)] {
            let ticks = linear(min, max, 5);
            assert!((2..=12).contains(&ticks.marks.len()), "{min} to {max}: {ticks:?}");
        }
    }

    #[test]
    fn powers_of_ten_are_named() {
        assert_eq!(labels(&logarithmic(1e-5, 1.0, 6)), ["10⁻⁵", "10⁻⁴", "10⁻³", "10⁻²", "10⁻¹", "10⁰"]);
        assert_eq!(labels(&logarithmic(1e-3, 1.0, 6)), ["0.001", "0.01", "0.1", "1"]);
        assert_eq!(labels(&logarithmic(1.0, 10.0, 6)), ["1", "2", "5", "10"]);
        assert!(logarithmic(1e-300, 1e300, 6).marks.len() <= 8);
    }
}
