//! A page in Markdown: its blocks of text, its links and the anchors of its headings.

use std::collections::HashMap;

use pulldown_cmark::{Event, Options, Parser, Tag, TagEnd};

/// A paragraph, an item of a list or a row of a table.
#[derive(Clone, Debug, Default)]
pub struct Block {
    /// Number of the first line, from 1.
    pub line: usize,
    /// Text without code. In a table row each cell is followed by the headings of its column and row.
    pub text: String,
    /// Links. The links of a table row include the links of the block before the table.
    pub links: Vec<String>,
}

/// A parsed page.
#[derive(Clone, Debug, Default)]
pub struct Page {
    /// Blocks in the order of the page.
    pub blocks: Vec<Block>,
    /// Links and image sources, with their line numbers.
    pub links: Vec<(usize, String)>,
    /// Anchors of the headings, as GitHub makes them.
    pub anchors: Vec<String>,
}

/// State of the parser within a table.
#[derive(Default)]
struct Table {
    /// Links of the block before the table, and of the headings.
    links: Vec<String>,
    headings: Vec<String>,
    cells: Vec<String>,
}

impl Page {
    /// Reads a page.
    pub fn parse(text: &str) -> Self {
        let mut page = Self::default();
        let mut block = Block::default();
        let mut table = Table::default();
        let mut headings: HashMap<String, usize> = HashMap::new();
        let (mut in_code, mut in_heading) = (false, false);
        let ends: Vec<usize> = text.match_indices('\n').map(|(end, _)| end).collect();
        for (event, range) in Parser::new_ext(text, Options::ENABLE_TABLES).into_offset_iter() {
            let line = ends.partition_point(|end| *end < range.start) + 1;
            match event {
                Event::Start(Tag::CodeBlock(_)) => in_code = true,
                Event::End(TagEnd::CodeBlock) => in_code = false,
                Event::Start(Tag::Table(_)) => {
                    page.finish(&mut block);
                    let links = page.blocks.last().map(|before| before.links.clone());
                    table = Table {
                        links: links.unwrap_or_default(),
                        ..Table::default()
                    };
                }
                Event::Start(Tag::Paragraph | Tag::Item | Tag::TableHead | Tag::TableRow) => {
                    page.finish(&mut block);
                    block.line = line;
                }
                Event::Start(Tag::Heading { .. }) => {
                    page.finish(&mut block);
                    in_heading = true;
                }
                Event::End(TagEnd::Paragraph | TagEnd::Item) => page.finish(&mut block),
                Event::End(TagEnd::Heading(_)) => {
                    in_heading = false;
                    let anchor = anchor(&std::mem::take(&mut block).text);
                    let count = headings.entry(anchor.clone()).or_default();
                    page.anchors.push(match *count {
                        0 => anchor,
                        count => format!("{anchor}-{count}"),
                    });
                    *count += 1;
                }
                Event::End(TagEnd::TableCell) => table.cells.push(std::mem::take(&mut block.text)),
                Event::End(TagEnd::TableHead) => {
                    table.headings = std::mem::take(&mut table.cells);
                    table.links.append(&mut block.links);
                }
                Event::End(TagEnd::TableRow) => {
                    block.text = row(&table.headings, &std::mem::take(&mut table.cells));
                    block.links.extend_from_slice(&table.links);
                    page.finish(&mut block);
                }
                Event::Start(Tag::Link { dest_url, .. }) => {
                    block.links.push(dest_url.to_string());
                    page.links.push((line, dest_url.into_string()));
                }
                Event::Start(Tag::Image { dest_url, .. }) => {
                    page.links.push((line, dest_url.into_string()));
                }
                Event::Text(text) if !in_code => block.text += &text,
                Event::Code(code) if in_heading => block.text += &code,
                Event::Code(_) => block.text.push('`'),
                Event::SoftBreak | Event::HardBreak => block.text.push(' '),
                _ => {}
            }
        }
        page
    }

    /// Ends the current block; adds the block if it has text.
    fn finish(&mut self, block: &mut Block) {
        let block = std::mem::take(block);
        if !block.text.trim().is_empty() {
            self.blocks.push(block);
        }
    }
}

/// The cells of a row, each with the headings of its column and row.
fn row(headings: &[String], cells: &[String]) -> String {
    let first = cells.first().map_or("", String::as_str);
    let with_headings =
        |(cell, heading): (&String, &String)| format!("{cell} {heading}; {cell} {first}");
    let cells = cells.iter().zip(headings).skip(1).map(with_headings);
    format!("{first}; {}", cells.collect::<Vec<_>>().join("; "))
}

/// The anchor of a heading.
fn anchor(heading: &str) -> String {
    let kept = heading
        .trim()
        .chars()
        .filter(|c| c.is_alphanumeric() || " -_".contains(*c));
    kept.flat_map(char::to_lowercase)
        .map(|c| if c == ' ' { '-' } else { c })
        .collect()
}

#[test]
fn a_row_has_its_headings_and_the_links_before_the_table() {
    let page = Page::parse("See [x](x.md):\n\n| frame | cycles |\n|---|---|\n| `a` | 12 |\n\nEnd.");
    let [_, row, end] = &page.blocks[..] else {
        panic!("{:?}", page.blocks)
    };
    assert!(row.text.contains("12 cycles"), "{row:?}");
    assert_eq!((row.line, &row.links[..]), (5, &["x.md".to_owned()][..]));
    assert_eq!((end.line, end.links.len()), (7, 0));
}

#[test]
fn an_item_is_a_block_and_code_is_not_read() {
    let page = Page::parse(
        "# Two `a` of it\n\n- one `12 cycles`\n- two\n  more\n\n```\n13 cycles\n```\n\n# Two `a` of it\n",
    );
    let texts: Vec<_> = page.blocks.iter().map(|block| &*block.text).collect();
    assert_eq!(texts, ["one `", "two more"]);
    assert_eq!(page.anchors, ["two-a-of-it", "two-a-of-it-1"]);
}
