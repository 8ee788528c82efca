//! The files of the page.
//!
//! The list does not contain `link.js`, which transports the messages; the program that serves the
//! page adds it.

/// Media type of scripts.
pub const SCRIPT: &str = "text/javascript; charset=utf-8";
const HTML: &str = "text/html; charset=utf-8";
const CSS: &str = "text/css; charset=utf-8";

/// A file of the page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct File {
    /// Name in the page's folder.
    pub name: &'static str,
    /// Media type.
    pub media: &'static str,
    /// Bytes of the file.
    pub content: &'static str,
}

/// The files, starting with the HTML page.
pub const FILES: [File; 11] = [
    file("index.html", HTML, include_str!("../web/index.html")),
    file("page.css", CSS, include_str!("../web/page.css")),
    file("page.js", SCRIPT, include_str!("../web/page.js")),
    file("monitor.js", SCRIPT, include_str!("../web/monitor.js")),
    file("console.js", SCRIPT, include_str!("../web/console.js")),
    file("orbit.js", SCRIPT, include_str!("../web/orbit.js")),
    file("panel.js", SCRIPT, include_str!("../web/panel.js")),
    file("motion.js", SCRIPT, include_str!("../web/motion.js")),
    file("upload.js", SCRIPT, include_str!("../web/upload.js")),
    file("curves.js", SCRIPT, include_str!("../web/curves.js")),
    file("tour.js", SCRIPT, include_str!("../web/tour.js")),
];

const fn file(name: &'static str, media: &'static str, content: &'static str) -> File {
    File {
        name,
        media,
        content,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_file_of_the_folder_is_here() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/web");
        let found = std::fs::read_dir(folder).unwrap();
        let found = found.map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let mut found: Vec<_> = found.collect();
        let mut known = FILES.map(|file| file.name).to_vec();
        found.sort();
        known.sort();
        assert_eq!(found, known);
    }
}
