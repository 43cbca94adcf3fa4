//! The page's frame.

/// A page that is being written.
#[derive(Debug)]
pub(super) struct Page {
    html: String,
}

impl Page {
    /// Everything up to the first heading.
    pub(super) fn new(title: &str) -> Self {
        let (title, style) = (escape(title), include_str!("../report.css"));
        let html = format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <title>{title}</title>\n<link rel=\"icon\" href=\"data:,\">\n<style>\n{style}</style>\n</head>\n<body>\n\
             <h1>{title}</h1>\n"
        );
        Self { html }
    }

    /// A heading.
    pub(super) fn section(&mut self, name: &str) {
        self.html += &format!("<h2>{}</h2>\n", escape(name));
    }

    /// Anything; it must be well-formed.
    pub(super) fn html(&mut self, html: &str) {
        self.html += html;
    }

    /// A picture with its caption.
    pub(super) fn figure(&mut self, svg: &str, caption: &str) {
        let caption = escape(caption);
        self.html += &format!(
            "<figure>\n<div class=\"wide\">{svg}</div>\n<figcaption>{caption}</figcaption>\n</figure>\n"
        );
    }

    /// A table: the heads, and rows of cells.
    pub(super) fn table(&mut self, heads: &[&str], rows: &[Vec<String>]) {
        let cells = |tag: &str, cells: &mut dyn Iterator<Item = &str>| {
            cells.map(|cell| format!("<{tag}>{}</{tag}>", escape(cell))).collect::<String>()
        };
        self.html += "<div class=\"wide\"><table>\n<thead><tr>";
        self.html += &cells("th", &mut heads.iter().copied());
        self.html += "</tr></thead>\n<tbody>\n";
        for row in rows {
            let row = cells("td", &mut row.iter().map(String::as_str));
            self.html += &format!("<tr>{row}</tr>\n");
        }
        self.html += "</tbody></table></div>\n";
    }

    /// The whole document.
    pub(super) fn finish(self) -> String {
        self.html + "</body>\n</html>\n"
    }
}

/// Text that may stand between tags and in attributes.
pub(super) fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// A count with a narrow space between every three digits.
pub(super) fn grouped(count: u64) -> String {
    let digits = count.to_string();
    let spaced = digits.char_indices().flat_map(|(index, digit)| {
        let is_first_of_three = index > 0 && (digits.len() - index).is_multiple_of(3);
        is_first_of_three.then_some('\u{202F}').into_iter().chain([digit])
    });
    spaced.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_counts_are_read_in_threes() {
        assert_eq!(
            [0, 999, 1000, 1_234_567].map(grouped),
            ["0", "999", "1\u{202F}000", "1\u{202F}234\u{202F}567"]
        );
    }

    #[test]
    fn text_cannot_become_markup() {
        let mut page = Page::new("a<b>\"&");
        page.table(&["<i>"], &[vec!["1 < 2".to_owned()]]);
        let html = page.finish();
        assert!(html.contains("<title>a&lt;b&gt;&quot;&amp;</title>") && html.contains("<td>1 &lt; 2</td>"));
        assert!(!html.contains("<i>"));
    }
}
