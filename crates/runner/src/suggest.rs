//! The name that was probably meant.

/// The name that differs from `text` in the fewest letters, if that is at most a third of its own.
#[must_use]
pub fn nearest<'a>(text: &str, names: &[&'a str]) -> Option<&'a str> {
    let (changes, name) = names.iter().map(|name| (distance(text, name), *name)).min_by_key(|near| near.0)?;
    (changes * 3 <= name.chars().count()).then_some(name)
}

/// Letters to change, add or remove (Levenshtein).
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, letter) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for j in 1..=b.len() {
            let replaced = diagonal + usize::from(letter != b[j - 1]);
            diagonal = row[j];
            row[j] = replaced.min(row[j] + 1).min(row[j - 1] + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_name_is_found_and_nothing_is_guessed() {
        let names = ["chirp", "force-pulse", "payload-200"];
        assert_eq!(nearest("chrip", &names), None, "two letters of five are too many");
        assert_eq!(nearest("chirps", &names), Some("chirp"));
        assert_eq!(nearest("payload-20", &names), Some("payload-200"));
        assert_eq!(nearest("xyzzy", &names), None);
    }
}
