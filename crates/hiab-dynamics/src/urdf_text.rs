//! Faults of a URDF's text, each with its line and the link or joint that it is in.
//!
//! `urdf-rs` reports such faults without either, so the text passes here first. Only what `tree` reads is looked
//! at; elements that belong to neither a link nor a joint may be anything. An attribute that an element does not
//! have is an error, since `urdf-rs` would pass over a misspelt `rpy` and leave a link unturned; so is an element
//! whose name is nearly that of one which counts.

use xml::EventReader;
use xml::attribute::OwnedAttribute;
use xml::common::Position;
use xml::reader::XmlEvent;

use crate::error::ModelError;
use crate::fault::TextFault;

/// Form of an attribute's value.
#[derive(Clone, Copy)]
enum Form {
    Text,
    Number,
    Vector,
}

/// An attribute that `tree` reads: element, attribute, form, and whether the element must have it.
const ATTRIBUTES: [(&str, &str, Form, bool); 19] = [
    ("link", "name", Form::Text, true),
    ("joint", "name", Form::Text, true),
    ("joint", "type", Form::Text, true),
    ("parent", "link", Form::Text, true),
    ("child", "link", Form::Text, true),
    ("axis", "xyz", Form::Vector, true),
    ("origin", "xyz", Form::Vector, false),
    ("origin", "rpy", Form::Vector, false),
    ("mass", "value", Form::Number, true),
    ("inertia", "ixx", Form::Number, true),
    ("inertia", "ixy", Form::Number, true),
    ("inertia", "ixz", Form::Number, true),
    ("inertia", "iyy", Form::Number, true),
    ("inertia", "iyz", Form::Number, true),
    ("inertia", "izz", Form::Number, true),
    ("limit", "lower", Form::Number, false),
    ("limit", "upper", Form::Number, false),
    ("limit", "effort", Form::Number, false),
    ("limit", "velocity", Form::Number, true),
];

/// Attributes that URDF knows but `tree` does not read.
const UNREAD: [(&str, &str); 1] = [("link", "type")];

/// Elements that `tree` reads, and in which others.
const ELEMENTS: [(&str, &[&str]); 3] = [
    ("link", &["inertial"]),
    ("joint", &["origin", "parent", "child", "axis", "limit", "mimic"]),
    ("inertial", &["origin", "mass", "inertia"]),
];

/// Elements that URDF knows beside these; they may be nearly called like one that counts.
const OTHER_ELEMENTS: [&str; 6] =
    ["visual", "collision", "dynamics", "calibration", "safety_controller", "contact"];

/// Elements that others must contain.
const CHILDREN: [(&str, &str); 4] =
    [("joint", "parent"), ("joint", "child"), ("inertial", "mass"), ("inertial", "inertia")];

/// An element whose end has not come yet.
struct Open {
    name: String,
    children: Vec<String>,
}

/// Refuses text that is not XML, and elements of links and joints that lack something or are no numbers.
pub(crate) fn check(text: &str) -> Result<(), ModelError> {
    let mut reader = EventReader::from_str(text);
    let mut open: Vec<Open> = Vec::new();
    let mut owner = String::new();
    loop {
        let event = reader.next()?;
        let fail = |owner: &str, fault| {
            let line = reader.position().row + 1;
            Err(ModelError::UrdfText { line, owner: owner.to_owned(), fault })
        };
        match event {
            XmlEvent::StartElement { name, attributes, .. } => {
                let name = name.local_name;
                if open.len() == 1 {
                    owner = match attributes.iter().find(|a| a.name.local_name == "name") {
                        Some(given) => format!("{name} `{}`", given.value),
                        None => format!("a {name}"),
                    };
                }
                let section =
                    if open.len() == 1 { Some(name.as_str()) } else { open.get(1).map(|o| &*o.name) };
                if matches!(section, Some("link" | "joint")) {
                    let outer = open.last().map_or("", |outer| &outer.name);
                    if let Err(fault) =
                        check_attributes(&name, &attributes).and_then(|()| check_spelling(outer, &name))
                    {
                        return fail(&owner, fault);
                    }
                }
                if let Some(parent) = open.last_mut() {
                    parent.children.push(name.clone());
                }
                open.push(Open { name, children: Vec::new() });
            }
            XmlEvent::EndElement { .. } => {
                let Some(closed) = open.pop() else { continue };
                let section = open.get(1).map_or(closed.name.as_str(), |section| &section.name);
                if matches!(section, "link" | "joint")
                    && let Err(fault) = check_children(&closed)
                {
                    return fail(&owner, fault);
                }
            }
            XmlEvent::EndDocument => return Ok(()),
            _ => {}
        }
    }
}

fn check_attributes(element: &str, attributes: &[OwnedAttribute]) -> Result<(), TextFault> {
    for (_, name, form, required) in ATTRIBUTES.iter().filter(|entry| entry.0 == element) {
        let (element, attribute) = (element.to_owned(), *name);
        let Some(given) = attributes.iter().find(|a| a.name.local_name == *name) else {
            if *required {
                return Err(TextFault::NoAttribute { element, attribute });
            }
            continue;
        };
        let count = given.value.split_whitespace().filter(|word| word.parse::<f64>().is_ok()).count();
        let whole = count == given.value.split_whitespace().count();
        let text = given.value.clone();
        match form {
            Form::Number if !(whole && count == 1) => {
                return Err(TextFault::NoNumber { element, attribute, text });
            }
            Form::Vector if !(whole && count == 3) => {
                return Err(TextFault::NoVector { element, attribute, text });
            }
            Form::Text | Form::Number | Form::Vector => {}
        }
    }
    let known = || {
        let read = ATTRIBUTES.iter().map(|entry| (entry.0, entry.1));
        read.chain(UNREAD).filter(|entry| entry.0 == element).map(|entry| entry.1)
    };
    if known().next().is_none() {
        return Ok(());
    }
    // Attributes of other namespaces are other programs'.
    let mut own = attributes.iter().map(|a| &a.name).filter(|name| name.prefix.is_none());
    match own.find(|name| known().all(|known| known != name.local_name)) {
        Some(name) => {
            let known = known().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
            let (element, attribute) = (element.to_owned(), name.local_name.clone());
            Err(TextFault::UnknownAttribute { element, attribute, known })
        }
        None => Ok(()),
    }
}

/// Refuses an element that is one slip away from one which `tree` reads there.
fn check_spelling(outer: &str, element: &str) -> Result<(), TextFault> {
    let Some((_, known)) = ELEMENTS.iter().find(|(name, _)| *name == outer) else { return Ok(()) };
    if known.contains(&element) || OTHER_ELEMENTS.contains(&element) {
        return Ok(());
    }
    match known.iter().find(|name| is_slip(element, name)) {
        Some(near) => {
            let (outer, child) = (outer.to_owned(), element.to_owned());
            Err(TextFault::UnknownElement { element: outer, child, near })
        }
        None => Ok(()),
    }
}

/// Whether `text` is `name` with one letter too many, too few or wrong, two swapped, or other capitals.
fn is_slip(text: &str, name: &str) -> bool {
    let text = text.to_ascii_lowercase();
    let (t, n) = (text.as_bytes(), name.as_bytes());
    let head = t.iter().zip(n).take_while(|(a, b)| a == b).count();
    let (t, n) = (&t[head..], &n[head..]);
    let tail = t.iter().rev().zip(n.iter().rev()).take_while(|(a, b)| a == b).count();
    match (&t[..t.len() - tail], &n[..n.len() - tail]) {
        ([] | [_], [] | [_]) => true,
        ([a, b], [c, d]) => (a, b) == (d, c),
        _ => false,
    }
}

fn check_children(closed: &Open) -> Result<(), TextFault> {
    let wanted = CHILDREN.iter().filter(|(element, _)| *element == closed.name);
    let mut missing = wanted.filter(|(_, child)| !closed.children.iter().any(|name| name == child));
    match missing.next() {
        Some((_, child)) => Err(TextFault::NoChild { element: closed.name.clone(), child }),
        None => Ok(()),
    }
}
