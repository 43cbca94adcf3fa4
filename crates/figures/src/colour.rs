//! Colours by their part in a figure, for light and dark paper.

/// A colour by name; what it looks like depends on the [`Theme`].
///
/// The eight series colours are those of Okabe and Ito, which stay apart for every common kind of colour blindness;
/// dark paper has them lighter. None of them carries a meaning alone: series differ in dash and marker too.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Colour {
    /// The background.
    Paper,
    /// Text and axes.
    Ink,
    /// Text of less weight.
    Muted,
    /// Grid lines.
    Grid,
    /// Blue.
    Blue,
    /// Red towards orange.
    Vermillion,
    /// Green towards blue.
    Green,
    /// Purple towards red.
    Purple,
    /// Orange.
    Orange,
    /// Light blue.
    Sky,
    /// Yellow.
    Yellow,
    /// Grey.
    Grey,
    /// A share of a colour scale, 0 for its dark and 255 for its bright end; the same in both themes.
    Scale(u8),
}

/// Which paper a figure is drawn on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Theme {
    /// White paper.
    Light,
    /// Nearly black paper.
    Dark,
}

/// Which paper an SVG is drawn on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SvgTheme {
    /// One theme for every reader.
    Fixed(Theme),
    /// What the reader's screen prefers; light where there is no preference, and on paper.
    Reader,
}

/// Red, green, blue.
pub(crate) type Rgb = [u8; 3];

/// Colours that depend on the theme, in the order of their SVG classes.
pub(crate) const NAMED: [(Colour, &str); 12] = [
    (Colour::Paper, "paper"),
    (Colour::Ink, "ink"),
    (Colour::Muted, "muted"),
    (Colour::Grid, "grid"),
    (Colour::Blue, "blue"),
    (Colour::Vermillion, "vermillion"),
    (Colour::Green, "green"),
    (Colour::Purple, "purple"),
    (Colour::Orange, "orange"),
    (Colour::Sky, "sky"),
    (Colour::Yellow, "yellow"),
    (Colour::Grey, "grey"),
];

/// Cividis, whose lightness rises evenly: it reads the same in grey and for every colour blindness.
const CIVIDIS: [Rgb; 10] = [
    [0x00, 0x22, 0x4e],
    [0x12, 0x35, 0x70],
    [0x3b, 0x49, 0x6c],
    [0x57, 0x5d, 0x6d],
    [0x70, 0x71, 0x73],
    [0x8a, 0x86, 0x78],
    [0xa5, 0x9c, 0x74],
    [0xc3, 0xb3, 0x69],
    [0xe1, 0xcc, 0x55],
    [0xfe, 0xe8, 0x38],
];

impl Colour {
    pub(crate) fn rgb(self, theme: Theme) -> Rgb {
        let (light, dark) = match self {
            Self::Paper => (0xffffff, 0x0d1117),
            Self::Ink => (0x1b1f24, 0xe6edf3),
            Self::Muted => (0x57606a, 0xa6b0bb),
            Self::Grid => (0xe4e7eb, 0x262d36),
            Self::Blue => (0x0072b2, 0x4ba3dd),
            Self::Vermillion => (0xd55e00, 0xf08a4b),
            Self::Green => (0x009e73, 0x2fc49a),
            Self::Purple => (0xb0578d, 0xe09cc3),
            Self::Orange => (0xe69f00, 0xf0b840),
            Self::Sky => (0x56b4e9, 0x8fd0f7),
            Self::Yellow => (0xd8c700, 0xf0e442),
            Self::Grey => (0x8c959f, 0x7d8792),
            Self::Scale(share) => return scale(share),
        };
        let value: u32 = match theme {
            Theme::Light => light,
            Theme::Dark => dark,
        };
        let [_, red, green, blue] = value.to_be_bytes();
        [red, green, blue]
    }
}

fn scale(share: u8) -> Rgb {
    let place = f64::from(share) / 255.0 * (CIVIDIS.len() - 1) as f64;
    let index = (place as usize).min(CIVIDIS.len() - 2);
    let part = place - index as f64;
    std::array::from_fn(|channel| {
        let (low, high) = (f64::from(CIVIDIS[index][channel]), f64::from(CIVIDIS[index + 1][channel]));
        (low + part * (high - low)).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Relative luminance of WCAG 2.
    fn luminance(rgb: Rgb) -> f64 {
        let linear = |channel: u8| {
            let c = f64::from(channel) / 255.0;
            if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
        };
        0.2126 * linear(rgb[0]) + 0.7152 * linear(rgb[1]) + 0.0722 * linear(rgb[2])
    }

    fn contrast(a: Colour, b: Colour, theme: Theme) -> f64 {
        let (a, b) = (luminance(a.rgb(theme)), luminance(b.rgb(theme)));
        (a.max(b) + 0.05) / (a.min(b) + 0.05)
    }

    #[test]
    fn text_can_be_read_on_either_paper() {
        for theme in [Theme::Light, Theme::Dark] {
            for colour in [Colour::Ink, Colour::Muted] {
                let contrast = contrast(colour, Colour::Paper, theme);
                assert!(contrast >= 4.5, "{colour:?} on {theme:?} has contrast {contrast}");
            }
        }
    }

    #[test]
    fn the_first_four_series_stand_out_from_either_paper() {
        for theme in [Theme::Light, Theme::Dark] {
            for colour in [Colour::Blue, Colour::Vermillion, Colour::Green, Colour::Purple] {
                let contrast = contrast(colour, Colour::Paper, theme);
                assert!(contrast >= 3.0, "{colour:?} on {theme:?} has contrast {contrast}");
            }
        }
    }

    #[test]
    fn the_colour_scale_gets_lighter_all_the_way() {
        let lightness: Vec<f64> = (0..=255).map(|share| luminance(scale(share))).collect();
        for pair in lightness.windows(2) {
            assert!(pair[0] <= pair[1] + 1e-3, "{pair:?}");
        }
        assert!(lightness[255] > 0.7 && lightness[0] < 0.02);
    }
}
