//! The committed header is the one that the sources give.

use std::path::Path;

#[test]
fn the_committed_header_is_current() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let path = folder.join("include/jbtg.h");
    let mut text = Vec::new();
    let config = cbindgen::Config::from_file(folder.join("cbindgen.toml")).unwrap();
    let mut builder = cbindgen::Builder::new().with_config(config);
    for file in ["status", "types", "functions"] {
        builder = builder.with_src(folder.join("src").join(file).with_extension("rs"));
    }
    builder.generate().unwrap().write(&mut text);
    // The sizes stand before the types that need them, which cbindgen cannot do.
    let text = String::from_utf8(text).unwrap();
    let sizes = format!(
        "/* Sizes of the objects that the caller provides memory for. */\n#define JBTG_JOINT_WORDS {}\n#define JBTG_STEP_WORDS {}\n#define JBTG_SAMPLER_WORDS {}\n\n",
        jbtg_c::JOINT_WORDS,
        jbtg_c::STEP_WORDS,
        jbtg_c::SAMPLER_WORDS
    );
    let wanted = text.replacen("/* Memory of one joint's", &(sizes + "/* Memory of one joint's"), 1);
    if std::env::var_os("UPDATE_HEADER").is_some_and(|value| value == "1") {
        std::fs::write(&path, &wanted).unwrap();
    }
    let found = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        found == wanted,
        "{} is out of date; rewrite it with: UPDATE_HEADER=1 cargo test -p jbtg-c --test header",
        path.display()
    );
}
