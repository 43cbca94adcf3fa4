//! The table file: what comes back, and what is refused and how.

use jbtg::strategies::planners;
use jbtg::{Shape, Timing};
use proptest::prelude::*;
use safezone::{BrakingTable, Knot, ParseError, SafeZone, Side, TableError, TableParts, ZoneError};

use crate::telescope::planner;

fn table() -> BrakingTable<'static> {
    BrakingTable::build(&planner(Shape::Smoothstep, Timing::Stretched)).expect("a table of six knots")
}

/// The text with the first `from` after `anchor` replaced.
#[track_caller]
fn edited(anchor: &str, from: &str, to: &str) -> String {
    let text = table().to_ron();
    let at = text.find(anchor).unwrap_or_else(|| panic!("no {anchor:?} in {text}"));
    let (head, tail) = text.split_at(at);
    assert!(tail.contains(from), "no {from:?} after {anchor:?} in {text}");
    format!("{head}{}", tail.replacen(from, to, 1))
}

#[track_caller]
fn check_refused(text: &str, parts: &[&str]) {
    let message = BrakingTable::from_ron(text).expect_err("bad text").to_string();
    for part in parts {
        assert!(message.contains(part), "expected {part:?} in {message:?}");
    }
    assert_eq!(message.lines().count(), 1, "{message:?}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn a_table_survives_its_text_bit_for_bit(planner in planners()) {
        let Ok(table) = BrakingTable::build(&planner) else { return Ok(()) };
        prop_assume!(table.knots(Side::Upper).len() + table.knots(Side::Lower).len() < 5000);
        let text = table.to_ron();
        let back = BrakingTable::from_ron(&text).map_err(|error| TestCaseError::fail(error.to_string()))?;
        prop_assert_eq!(back.hash(), table.hash());
        prop_assert_eq!(back.to_ron(), text);
        prop_assert_eq!(back, table);
    }

    /// Any single damaged digit: never read as whole.
    #[test]
    fn a_damaged_digit_is_refused(at in any::<prop::sample::Index>(), digit in b'0'..=b'9') {
        let mut text = table().to_ron().into_bytes();
        let header = text.iter().position(|byte| *byte == b'(').expect("a body");
        let digits: Vec<usize> = (header..text.len()).filter(|i| text[*i].is_ascii_digit()).collect();
        let at = digits[at.index(digits.len())];
        prop_assume!(text[at] != digit);
        text[at] = digit;
        let damaged = String::from_utf8(text)?;
        prop_assert!(BrakingTable::from_ron(&damaged).map_or(true, |read| read == table()), "{damaged}");
    }
}

#[test]
fn a_table_for_other_limits_shape_timing_or_period_is_stale() {
    for (shape, timing) in [(Shape::SineQuintic, Timing::Stretched), (Shape::Smoothstep, Timing::Fastest)] {
        let error = SafeZone::new(planner(shape, timing), table()).unwrap_err();
        assert_eq!(error, ZoneError::Stale { hash: table().hash() });
        assert!(error.to_string().contains("run `cargo xtask tables`"), "{error}");
    }
}

#[test]
fn a_tampered_knot_is_corruption() {
    let knot = table().knots(Side::Upper)[3].distance.to_string();
    check_refused(&edited("upper", &knot, "0.001"), &["corrupted", &format!("{:016x}", table().hash())]);
}

#[test]
fn a_tampered_limit_is_corruption() {
    check_refused(&edited("jerk", "100.0", "200.0"), &["corrupted"]);
}

#[test]
fn an_unknown_key_is_refused_with_its_place() {
    check_refused(&edited("subdivisions", "subdivisions", "divisions"), &["divisions", ":"]);
    check_refused(&edited("upper", "distance", "mass: 1.0, distance"), &["mass", ":"]);
}

#[test]
fn a_truncated_file_is_refused_at_every_length() {
    let text = table().to_ron();
    let end = text.trim_end().len();
    for length in (0..end).filter(|length| text.is_char_boundary(*length)) {
        let error = BrakingTable::from_ron(&text[..length]).unwrap_err();
        assert!(matches!(error, ParseError::Syntax(_)), "{length} of {end} bytes: {error}");
    }
}

#[test]
fn another_schema_is_refused_with_the_command_that_repairs_it() {
    check_refused(&edited("schema", "1", "7"), &["schema 7", "run `cargo xtask tables`"]);
}

#[test]
fn a_hash_that_is_none_is_refused() {
    let hash = format!("{:016x}", table().hash());
    check_refused(&edited("hash", &hash, "beef"), &["sixteen hexadecimal digits", "beef"]);
    check_refused(&edited("hash", &hash, "+123456789abcdef"), &["sixteen hexadecimal digits"]);
}

/// A table with other knots and the hash that belongs to them.
#[track_caller]
fn check_forged(forge: impl Fn(&mut Vec<Knot>), check: impl Fn(Result<BrakingTable<'_>, TableError>)) {
    let honest = table();
    let (mut upper, lower) = (honest.knots(Side::Upper).to_vec(), honest.knots(Side::Lower).to_vec());
    forge(&mut upper);
    let built_from = *honest.built_from();
    let mut parts = TableParts { built_from, subdivisions: 1, upper: &upper, lower: &lower, hash: 0 };
    if let Err(TableError::Corrupted { found, .. }) = BrakingTable::try_from(parts) {
        parts.hash = found;
    }
    check(BrakingTable::try_from(parts));
}

#[test]
fn knots_out_of_order_are_refused_even_with_their_hash() {
    let malformed = |index| Err(TableError::Malformed { side: Side::Upper, index });
    check_forged(|knots| knots[2].velocity *= 1.1, |table| assert_eq!(table, malformed(2)));
    check_forged(|knots| knots[3].distance = knots[2].distance, |table| assert_eq!(table, malformed(3)));
    check_forged(|knots| knots[4].distance = f64::NAN, |table| assert_eq!(table, malformed(4)));
    check_forged(|knots| knots[0].distance = 1e-3, |table| assert_eq!(table, malformed(0)));
    check_forged(|knots| knots[5].distance *= 2.0, |table| assert_eq!(table, malformed(5)));
    check_forged(Vec::clear, |table| assert_eq!(table, malformed(0)));
}

#[test]
fn knots_that_promise_another_distance_are_refused_even_with_their_hash() {
    let planner = planner(Shape::Smoothstep, Timing::Stretched);
    check_forged(
        |knots| knots[3].distance *= 0.999,
        |table| {
            let error = SafeZone::new(planner, table.expect("knots in order")).unwrap_err();
            assert!(matches!(error, ZoneError::Distance { side: Side::Upper, .. }), "{error}");
        },
    );
    check_forged(
        |knots| knots[3].distance *= 1.001,
        |table| {
            let error = SafeZone::new(planner, table.expect("knots in order")).unwrap_err();
            assert!(matches!(error, ZoneError::Distance { side: Side::Upper, .. }), "{error}");
        },
    );
    check_forged(
        |knots| {
            let spacing = 0.999 * knots[1].velocity;
            knots.iter_mut().enumerate().for_each(|(i, knot)| knot.velocity = i as f64 * spacing);
        },
        |table| {
            let error = SafeZone::new(planner, table.expect("knots in order")).unwrap_err();
            assert!(matches!(error, ZoneError::Spacing { side: Side::Upper, .. }), "{error}");
        },
    );
}
