//! Where two values of one form differ, field by field.

use serde::Serialize;
use serde_json::Value;

/// Every field in which `ours` and `theirs` differ, by its path, with both values.
///
/// One line of text per field: `learner.batch_size: the run has 128, wanted is 64`. Empty if they are equal.
///
/// # Errors
/// A value has no JSON form.
pub fn differences(ours: &impl Serialize, theirs: &impl Serialize) -> serde_json::Result<Vec<String>> {
    let mut found = Vec::new();
    compare("", Some(&serde_json::to_value(ours)?), Some(&serde_json::to_value(theirs)?), &mut found);
    Ok(found)
}

fn compare(path: &str, ours: Option<&Value>, theirs: Option<&Value>, found: &mut Vec<String>) {
    match (ours, theirs) {
        (Some(Value::Object(ours)), Some(Value::Object(theirs))) => {
            let dot = if path.is_empty() { "" } else { "." };
            let beyond = theirs.keys().filter(|key| !ours.contains_key(*key));
            for key in ours.keys().chain(beyond) {
                compare(&format!("{path}{dot}{key}"), ours.get(key), theirs.get(key), found);
            }
        }
        // Lists of one length differ item by item, others as a whole.
        (Some(Value::Array(ours)), Some(Value::Array(theirs))) if ours.len() == theirs.len() => {
            for (index, (ours, theirs)) in ours.iter().zip(theirs).enumerate() {
                compare(&format!("{path}[{index}]"), Some(ours), Some(theirs), found);
            }
        }
        _ if ours == theirs => {}
        _ => {
            let shown = |value: Option<&Value>| value.map_or_else(|| "nothing".to_owned(), Value::to_string);
            found.push(format!("{path}: the run has {}, wanted is {}", shown(ours), shown(theirs)));
        }
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn every_field_that_differs_is_named_by_its_path() {
        let ours = json!({
            "seed": 0,
            "learner": {"batch_size": 128, "hidden": [256, 256], "target_entropy": null},
            "task": {"moving": ["lift", "tilt"]},
            "motion": {"margin": {"lift": 0.1}},
        });
        let theirs = json!({
            "seed": 0,
            "learner": {"batch_size": 64, "hidden": [256, 128], "target_entropy": -3.0},
            "task": {"moving": ["lift"]},
            "motion": {"margin": {"lift": 0.1, "tilt": 0.2}},
        });
        assert_eq!(differences(&ours, &ours).unwrap(), [""; 0]);
        assert_eq!(
            differences(&ours, &theirs).unwrap(),
            [
                "learner.batch_size: the run has 128, wanted is 64",
                "learner.hidden[1]: the run has 256, wanted is 128",
                "learner.target_entropy: the run has null, wanted is -3.0",
                "motion.margin.tilt: the run has nothing, wanted is 0.2",
                "task.moving: the run has [\"lift\",\"tilt\"], wanted is [\"lift\"]",
            ]
        );
    }
}
