//! `cargo xtask interface`: lists the public interface of `glint-program`, the library for programs.
//!
//! A line of the list has the module from which programs import an item, and the item in Rust syntax, without bodies and private fields.
//! The list is read from the sources, so it names types as the sources do. Modules and items for the soft core alone, and tests, are not
//! part of the interface.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::{fs, mem};

use anyhow::{Context, Result, bail};
use proc_macro2::{Group, Span, TokenStream, TokenTree};
use syn::{
    Attribute, Block, Expr, ExprLit, Fields, File, Ident, ImplItem, Item, ItemImpl, Lit, Meta,
    TraitItem, Type, UseTree, Visibility, parse_quote,
};

use crate::{generated, paths};

/// The committed list.
const LIST: &str = "firmware/program/interface.txt";
const COMMAND: &str = "cargo xtask interface";
const SOURCES: &str = "firmware/program/src";
const CRATE: &str = "glint_program";
/// Attributes that are part of the interface.
const ATTRIBUTES: [&str; 3] = ["derive", "non_exhaustive", "repr"];

/// Writes the list. With `check`, compares it with the committed list instead.
///
/// # Errors
/// A source cannot be read, an item has no example in its documentation, or (with `check`) the interface differs from the list; the error
/// lists the items without an example, or the differences.
pub fn write(check: bool) -> Result<()> {
    let folder = paths::root().join(SOURCES);
    let interface = Interface::load(&|path| {
        let path = folder.join(path);
        fs::read_to_string(&path).with_context(|| format!("reading {}", path.display()))
    })?;
    if !interface.without_example.is_empty() {
        bail!(
            "no example in the documentation of:\n{}",
            interface.without_example.join("\n")
        );
    }
    let text = interface.lines.join("\n") + "\n";
    if !check {
        return generated::write(&[(LIST, text)], COMMAND, false);
    }
    let path = paths::root().join(LIST);
    let committed = fs::read_to_string(&path)
        .with_context(|| format!("reading {} (`{COMMAND}` writes it)", path.display()))?;
    let changes = changes(&committed, &text);
    if !changes.is_empty() {
        bail!(
            "the interface of programs has changed; run `{COMMAND}`, commit {LIST}, and state the change in CHANGELOG.md:\n{}",
            changes.join("\n")
        );
    }
    Ok(())
}

/// The lines that are only in `before`, prefixed with `-`, and the lines that are only in `after`, prefixed with `+`, in the order of their
/// texts.
fn changes(before: &str, after: &str) -> Vec<String> {
    let [before, after] = [before, after].map(|text| text.lines().collect::<BTreeSet<_>>());
    let changed = before.symmetric_difference(&after);
    changed
        .map(|line| format!("{} {line}", if after.contains(line) { '+' } else { '-' }))
        .collect()
}

/// Reads the text of a source file, which is given relative to the folder of the sources.
type ReadSource<'a> = &'a dyn Fn(&Path) -> Result<String>;

/// The public interface of a library.
#[derive(Default)]
struct Interface {
    /// The items, sorted.
    lines: Vec<String>,
    /// The items that need an example in their documentation and have none.
    without_example: Vec<String>,
}

impl Interface {
    /// Reads the interface of a crate from its root module `lib.rs`.
    fn load(read: ReadSource) -> Result<Self> {
        let mut modules = Vec::new();
        let root = Module {
            path: CRATE.to_owned(),
            ..Module::default()
        };
        root.load(Path::new("lib.rs"), Path::new(""), read, &mut modules)?;
        let places = modules.iter().flat_map(Module::places).collect();
        let mut interface = Self::default();
        for module in modules {
            for item in &module.items {
                interface.add(&module, item.clone(), &places);
            }
        }
        interface.lines.sort();
        interface.without_example.sort();
        Ok(interface)
    }

    /// Adds the lines of an item. `places` has the modules from which programs import the types.
    fn add(&mut self, module: &Module, item: Item, places: &BTreeMap<String, String>) {
        match item {
            Item::Impl(block) => {
                let place = match &*block.self_ty {
                    Type::Path(of) => {
                        let name = of.path.segments.last().map(|part| part.ident.to_string());
                        name.and_then(|name| places.get(&name))
                    }
                    _ => Some(&module.path),
                };
                if let Some(place) = place {
                    self.add_block(place, block);
                }
            }
            Item::Macro(mut exported) if has(&exported.attrs, "macro_export") => {
                let documentation = reduce(&mut exported.attrs);
                exported.mac.tokens = without_bodies(exported.mac.tokens);
                self.push(CRATE, Item::Macro(exported), Some(&documentation));
            }
            Item::Use(mut import)
                if is_public(&import.vis) && !module.has_child_of(&import.tree) =>
            {
                import.attrs.clear();
                self.push(&module.path, Item::Use(import), None);
            }
            Item::Mod(mut child) if is_public(&child.vis) => {
                child.attrs.clear();
                self.push(&module.path, Item::Mod(child), None);
            }
            mut item => {
                if let Some((name, attributes)) = public(&mut item)
                    && let Some(place) = module.place(&name.to_string())
                {
                    let documentation = reduce(attributes);
                    self.add_definition(&place, item, &documentation);
                }
            }
        }
    }

    /// Adds a line for each public item of an inherent `impl` block, or a single line for the `impl` of a trait.
    fn add_block(&mut self, place: &str, mut block: ItemImpl) {
        block.attrs.clear();
        let items = mem::take(&mut block.items);
        if block.trait_.is_some() {
            let types = items.into_iter();
            block.items = types
                .filter(|item| matches!(item, ImplItem::Type(_)))
                .collect();
            return self.push(place, Item::Impl(block), None);
        }
        for mut item in items {
            let (visibility, attributes) = match &mut item {
                ImplItem::Fn(function) => {
                    function.block = empty();
                    (&function.vis, &mut function.attrs)
                }
                ImplItem::Const(constant) => (&constant.vis, &mut constant.attrs),
                _ => continue,
            };
            if is_public(visibility) {
                let documentation = reduce(attributes);
                block.items = vec![item];
                self.push(place, Item::Impl(block.clone()), Some(&documentation));
            }
        }
    }

    /// Adds the line of a type, a function or a constant, or the lines of a trait and its items.
    fn add_definition(&mut self, place: &str, mut item: Item, documentation: &str) {
        match &mut item {
            Item::Fn(function) => *function.block = empty(),
            Item::Struct(of) => reduce_fields(&mut of.fields),
            Item::Enum(of) => {
                for variant in &mut of.variants {
                    variant.attrs.clear();
                    for field in &mut variant.fields {
                        field.attrs.clear();
                    }
                }
            }
            Item::Trait(of) => {
                for mut member in mem::take(&mut of.items) {
                    let documentation = match &mut member {
                        TraitItem::Fn(function) => {
                            function.default = function.default.as_ref().map(|_| empty());
                            Some(reduce(&mut function.attrs))
                        }
                        _ => None,
                    };
                    let mut with_member = of.clone();
                    with_member.items = vec![member];
                    self.push(place, Item::Trait(with_member), documentation.as_deref());
                }
            }
            _ => {}
        }
        self.push(place, item, Some(documentation));
    }

    /// Adds a line. `documentation` is the documentation of the item; `None` if the item needs no example.
    fn push(&mut self, place: &str, item: Item, documentation: Option<&str>) {
        let line = format!("{place}: {}", one_line(item));
        if documentation.is_some_and(|text| !text.contains("```")) {
            self.without_example.push(line.clone());
        }
        self.lines.push(line);
    }
}

/// A module of the library.
#[derive(Default)]
struct Module {
    path: String,
    /// If this module is private: the module that re-exports items of this module, and the names of these items.
    exports: Option<(String, BTreeSet<String>)>,
    items: Vec<Item>,
}

impl Module {
    /// Reads the module in `file`, whose child modules are in `folder`, and adds all of these modules to `modules`.
    fn load(
        mut self,
        file: &Path,
        folder: &Path,
        read: ReadSource,
        modules: &mut Vec<Self>,
    ) -> Result<()> {
        let parsed = syn::parse_file(&read(file)?);
        self.items = parsed
            .with_context(|| format!("parsing {}", file.display()))?
            .items;
        self.items.retain(|item| match item {
            Item::Mod(child) => !is_excluded(&child.attrs),
            _ => true,
        });
        for item in &self.items {
            let Item::Mod(child) = item else {
                continue;
            };
            let name = child.ident.to_string();
            let exports = self.exports_of(&name)?;
            let is_private = !is_public(&child.vis);
            let module = Self {
                path: format!("{}::{name}", self.path),
                exports: is_private.then(|| (self.path.clone(), exports)),
                items: Vec::new(),
            };
            let folder = folder.join(&name);
            module.load(&folder.with_extension("rs"), &folder, read, modules)?;
        }
        modules.push(self);
        Ok(())
    }
    /// The names that this module re-exports from its child module `name`.
    ///
    /// # Errors
    /// A re-export is not the name of an item.
    fn exports_of(&self, name: &str) -> Result<BTreeSet<String>> {
        let mut names = BTreeSet::new();
        for item in &self.items {
            if let Item::Use(import) = item
                && let UseTree::Path(path) = &import.tree
                && is_public(&import.vis)
                && path.ident == name
            {
                names.extend(leaves(&path.tree)?);
            }
        }
        Ok(names)
    }

    /// Whether a `use` names an item of a child module.
    fn has_child_of(&self, tree: &UseTree) -> bool {
        let UseTree::Path(path) = tree else {
            return false;
        };
        let mut items = self.items.iter();
        items.any(|item| matches!(item, Item::Mod(child) if child.ident == path.ident))
    }

    /// The module from which programs import the public item `name` of this module; `None` if they cannot.
    fn place(&self, name: &str) -> Option<String> {
        match &self.exports {
            None => Some(self.path.clone()),
            Some((parent, names)) => names.contains(name).then(|| parent.clone()),
        }
    }

    /// The names of the public items of this module, each with the module from which programs import it.
    fn places(&self) -> impl Iterator<Item = (String, String)> {
        self.items.iter().filter_map(|item| {
            let (name, _) = public(&mut item.clone())?;
            Some((name.to_string(), self.place(&name.to_string())?))
        })
    }
}

/// The names at the ends of the tree of a `use`.
///
/// # Errors
/// An end is not the name of an item.
fn leaves(tree: &UseTree) -> Result<Vec<String>> {
    Ok(match tree {
        UseTree::Path(path) => leaves(&path.tree)?,
        UseTree::Name(name) => vec![name.ident.to_string()],
        UseTree::Group(group) => {
            let parts = group.items.iter().map(leaves);
            parts.collect::<Result<Vec<_>>>()?.concat()
        }
        UseTree::Rename(_) | UseTree::Glob(_) => {
            bail!("`pub use` of the library's own items: expected their names, found `as` or `*`")
        }
    })
}

/// The name and the attributes of a public definition with a name; `None` for any other item.
fn public(item: &mut Item) -> Option<(Ident, &mut Vec<Attribute>)> {
    use syn::{ItemConst, ItemEnum, ItemFn, ItemStatic, ItemStruct, ItemTrait, ItemType};
    #[rustfmt::skip]
    let (visibility, name, attributes) = match item {
        Item::Fn(ItemFn { vis, sig, attrs, .. }) => (vis, &sig.ident, attrs),
        Item::Const(ItemConst { vis, ident, attrs, .. })
        | Item::Enum(ItemEnum { vis, ident, attrs, .. })
        | Item::Static(ItemStatic { vis, ident, attrs, .. })
        | Item::Struct(ItemStruct { vis, ident, attrs, .. })
        | Item::Trait(ItemTrait { vis, ident, attrs, .. })
        | Item::Type(ItemType { vis, ident, attrs, .. }) => (vis, &*ident, attrs),
        _ => return None,
    };
    is_public(visibility).then(|| (name.clone(), attributes))
}

const fn is_public(visibility: &Visibility) -> bool {
    matches!(visibility, Visibility::Public(_))
}

fn has(attributes: &[Attribute], name: &str) -> bool {
    attributes
        .iter()
        .any(|attribute| attribute.path().is_ident(name))
}

/// Whether an item is for the soft core alone, or for tests.
fn is_excluded(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| match &attribute.meta {
        Meta::List(list) if list.path.is_ident("cfg") => {
            let condition = list.tokens.to_string();
            condition == "test" || condition.starts_with("target_arch")
        }
        _ => false,
    })
}

/// Removes the attributes that are not part of the interface. Returns the documentation.
fn reduce(attributes: &mut Vec<Attribute>) -> String {
    let mut documentation = String::new();
    attributes.retain(|attribute| {
        if let Meta::NameValue(pair) = &attribute.meta
            && pair.path.is_ident("doc")
            && let Expr::Lit(ExprLit {
                lit: Lit::Str(text),
                ..
            }) = &pair.value
        {
            documentation += &text.value();
            documentation.push('\n');
        }
        ATTRIBUTES
            .iter()
            .any(|name| attribute.path().is_ident(name))
    });
    documentation
}

/// Replaces each private field by `_`, and keeps only one of several private fields with names.
fn reduce_fields(fields: &mut Fields) {
    for field in fields.iter_mut() {
        field.attrs.clear();
        if !is_public(&field.vis) {
            field.vis = Visibility::Inherited;
            field.ident = field
                .ident
                .as_ref()
                .map(|_| Ident::new("_", Span::call_site()));
            field.ty = parse_quote!(_);
        }
    }
    if let Fields::Named(named) = fields {
        let all = mem::take(&mut named.named);
        let (public, private): (Vec<_>, Vec<_>) =
            all.into_iter().partition(|field| is_public(&field.vis));
        named.named = public
            .into_iter()
            .chain(private.into_iter().take(1))
            .collect();
    }
}

fn empty() -> Block {
    parse_quote!({})
}

/// The patterns of a macro's rules, without the expansions.
fn without_bodies(rules: TokenStream) -> TokenStream {
    let mut follows_arrow = false;
    let reduced = rules.into_iter().map(|token| match token {
        TokenTree::Group(group) if follows_arrow => {
            follows_arrow = false;
            Group::new(group.delimiter(), TokenStream::new()).into()
        }
        token => {
            follows_arrow = matches!(&token, TokenTree::Punct(sign) if sign.as_char() == '>');
            token
        }
    });
    reduced.collect()
}

/// An item in Rust syntax on one line, with `;` in place of empty bodies, and `..` in place of private fields.
fn one_line(item: Item) -> String {
    let has_bodies = matches!(item, Item::Fn(_) | Item::Impl(_));
    let text = prettyplease::unparse(&File {
        shebang: None,
        frontmatter: None,
        attrs: Vec::new(),
        items: vec![item],
    });
    let words: Vec<_> = text.split_whitespace().collect();
    let mut line = words.join(" ");
    if has_bodies {
        line = line.replace(" {}", ";");
    }
    // The printer breaks long lines after `(` and `<`.
    for (broken, whole) in [
        ("( ", "("),
        (", )", ")"),
        ("< ", "<"),
        (", >", ">"),
        (", }", " }"),
        ("_: _", ".."),
    ] {
        line = line.replace(broken, whole);
    }
    line
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIB: &str = "
        mod board;
        pub mod lines;
        #[cfg(target_arch = \"riscv32\")]
        pub mod hardware;
        pub use board::{Board, Program};
        pub use other_crate as other;
        /// ```
        /// ```
        #[macro_export]
        macro_rules! run { ($program:ty) => { fn main() {} }; }
    ";

    /// The interface of a crate with `LIB` as its root, and with these texts of the modules `board` and `lines`.
    fn interface(board: &str, lines: &str) -> Interface {
        let read = |path: &Path| {
            Ok(match path.to_str() {
                Some("lib.rs") => LIB,
                Some("board.rs") => board,
                Some("lines.rs") => lines,
                _ => bail!("{}", path.display()),
            }
            .to_owned())
        };
        Interface::load(&read).unwrap()
    }

    /// The lines of the items in the modules, without the lines of the items in `LIB`.
    fn lines(board: &str, lines: &str) -> Vec<String> {
        let of_lib = interface("", "").lines;
        let all = interface(board, lines).lines;
        all.into_iter()
            .filter(|line| !of_lib.contains(line))
            .collect()
    }

    #[test]
    fn modules_imports_and_macros_are_listed() {
        assert_eq!(
            interface("", "").lines,
            [
                "glint_program: macro_rules! run { ($program:ty) => {}; }",
                "glint_program: pub mod lines;",
                "glint_program: pub use other_crate as other;",
            ]
        );
    }

    #[test]
    fn an_item_has_the_path_that_programs_import() {
        assert_eq!(
            lines(
                "pub struct Board; pub struct Hidden;",
                "pub const A: u8 = 3; const B: u8 = 4;"
            ),
            [
                "glint_program: pub struct Board;",
                "glint_program::lines: pub const A: u8 = 3;",
            ]
        );
    }

    #[test]
    fn private_fields_and_methods_are_left_out() {
        let board = "
            /// A board.
            #[derive(Clone)] #[must_use]
            pub struct Board<T: Copy> { pub(crate) a: u8, /// LEDs.
                pub leds: u16, b: T }
            impl<T: Copy> Board<T> {
                pub const fn leds(&self) -> u16 { self.leds }
                fn a(&self) -> u8 { self.a }
            }
            pub enum Hidden { A }
            impl Hidden { pub fn a(&self) {} }
        ";
        assert_eq!(
            lines(board, ""),
            [
                "glint_program: #[derive(Clone)] pub struct Board<T: Copy> { pub leds: u16, .. }",
                "glint_program: impl<T: Copy> Board<T> { pub const fn leds(&self) -> u16; }",
            ]
        );
    }

    #[test]
    fn each_function_of_a_trait_has_a_line() {
        let board = "pub trait Program: Sized { fn start() -> Self; fn paint(&self) { f() } } impl Program for () {}";
        assert_eq!(
            lines(board, ""),
            [
                "glint_program: pub trait Program: Sized { fn paint(&self) {} }",
                "glint_program: pub trait Program: Sized { fn start() -> Self; }",
                "glint_program: pub trait Program: Sized {}",
                "glint_program::board: impl Program for ();",
            ]
        );
    }

    #[test]
    fn a_long_item_is_a_line() {
        let function = "pub fn text(first_argument: &mut [u8], second_argument: &'static str, third: usize) -> Option<usize> { None }";
        assert_eq!(
            lines("", function),
            [format!(
                "glint_program::lines: {}",
                function.replace(" { None }", ";")
            )]
        );
    }

    #[test]
    fn an_export_under_another_name_is_refused() {
        for text in ["mod a; pub use a::{B as C};", "mod a; pub use a::*;"] {
            let loaded = Interface::load(&|_| Ok(text.to_owned()));
            assert!(loaded.is_err_and(|error| error.to_string().contains("expected their names")));
        }
    }

    #[test]
    fn an_item_without_an_example_is_named() {
        let lines = "/// A.\n///\n/// ```\n/// ```\npub fn a() {}\n/// B.\npub fn b() {}\nimpl Clone for Board {}";
        let missing = interface("pub struct Board;", lines).without_example;
        assert_eq!(
            missing,
            [
                "glint_program: pub struct Board;",
                "glint_program::lines: pub fn b();"
            ]
        );
    }

    #[test]
    fn changed_lines_are_named() {
        assert_eq!(changes("a\nb\nd\n", "a\nc\nd\n"), ["- b", "+ c"]);
        assert!(changes("a\n", "a\n").is_empty());
    }
}
