//! The name that was probably meant.

/// The name closest to `text`, if it is close enough to have been meant: at most a third of its
/// letters changed, added, left out or swapped with their neighbour, or `text` begins it.
pub(crate) fn nearest<'a>(text: &str, names: &[&'a str]) -> Option<&'a str> {
    let text = text.to_ascii_lowercase().replace('_', "-");
    let distances = names.iter().map(|name| {
        let plain = name.to_ascii_lowercase().replace('_', "-");
        let begins = text.chars().count() >= 2 && plain.starts_with(&text);
        (if begins { 0 } else { distance(&text, &plain) }, *name)
    });
    let (changes, name) = distances.min_by_key(|(changes, _)| *changes)?;
    (changes * 3 <= name.chars().count().max(3)).then_some(name)
}

/// Letters to change, add, remove, or swap with their neighbour (optimal string alignment).
fn distance(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().collect(), b.chars().collect());
    let mut rows: Vec<Vec<usize>> = vec![(0..=b.len()).collect()];
    for i in 1..=a.len() {
        let mut row = vec![i];
        for j in 1..=b.len() {
            let replaced = rows[i - 1][j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let mut least = replaced.min(rows[i - 1][j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                least = least.min(rows[i - 2][j - 2] + 1);
            }
            row.push(least);
        }
        rows.push(row);
    }
    rows[a.len()][b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_of_the_fingers_are_understood() {
        let names = ["train", "tables", "tidy", "lift_joint", "purple"];
        for (text, meant) in [
            ("trian", "train"),
            ("tran", "train"),
            ("table", "tables"),
            ("Purple", "purple"),
            ("lift-joint", "lift_joint"),
            ("lift_jiont", "lift_joint"),
            ("lif", "lift_joint"),
        ] {
            assert_eq!(nearest(text, &names), Some(meant), "{text}");
        }
    }

    #[test]
    fn something_else_altogether_is_not_guessed_at() {
        for text in ["frobnicate", "x", "", "green"] {
            assert_eq!(nearest(text, &["train", "tidy", "orange"]), None, "{text}");
        }
    }

    #[test]
    fn distance_counts_each_kind_of_slip_once() {
        for (a, b, count) in
            [("", "abc", 3), ("abc", "abc", 0), ("abc", "acb", 1), ("abc", "adc", 1), ("ab", "xb", 1)]
        {
            assert_eq!((distance(a, b), distance(b, a)), (count, count), "{a} {b}");
        }
    }
}
