//! Tests the search for cycles on small crates with files given as text.

use std::path::Path;

use super::Crate;

fn load(files: &[(&str, &str)]) -> Crate {
    let read = |path: &Path| {
        files
            .iter()
            .find(|(name, _)| Path::new(name) == path)
            .map(|(_, text)| (*text).to_owned())
    };
    Crate::load(Path::new("lib.rs"), &read).unwrap()
}

/// The dependencies in cycles, without `crate::`.
fn cycles(files: &[(&str, &str)]) -> Vec<String> {
    let cycles = load(files).cycles();
    let cycles = cycles.iter();
    cycles
        .map(|dependency| dependency.replace("crate::", ""))
        .collect()
}

/// Returns the dependencies in cycles of a crate whose modules `a` and `b` have the given texts.
fn of_pair(a: &str, b: &str) -> Vec<String> {
    cycles(&[("lib.rs", "mod a; mod b;"), ("a.rs", a), ("b.rs", b)])
}

const NONE: [&str; 0] = [];
const CYCLE: [&str; 2] = ["a → b (B)", "b → a (A)"];

#[test]
fn imports_down_make_no_cycle() {
    assert_eq!(
        of_pair("use crate::b::B; pub struct A(B);", "pub struct B;"),
        NONE
    );
}

#[test]
fn imports_of_each_other_make_a_cycle() {
    for a in [
        "use crate::b::B; pub struct A(B);",
        "use super::b::B as Other; pub struct A(Other);",
        "use crate::{b::{self, B}}; pub struct A(B);",
        "use crate::b; pub struct A(b::B);",
        "use crate::b::*; pub struct A(B);",
        "pub struct A(super::b::B);",
        "pub struct A; impl From<crate::b::B> for A { fn from(_: crate::b::B) -> A { A } }",
        "pub struct A; fn f() -> u32 { self::super::b::B::default().0 }",
        "pub struct A; fn f() { use crate::b::B as C; C::new(); }",
        "pub struct A; fn f() { use crate::b; b::B::new(); }",
        "pub struct A; fn f() { println!(\"{}\", x.y(&[super::b::B::NAME])); }",
        "pub struct A; fn f() { g!(0..super::b::B::LIMIT) }",
        "pub struct A; fn f() -> bool { matches!(g(), crate::b::B { .. }) }",
        "#[derive(Parser)] pub struct A { #[arg(value_parser = crate::b::B::parse)] a: u32 }",
        "pub struct A; macro_rules! b { () => { $crate::b::B } }",
        "pub struct A; mod inner { struct C(super::super::b::B); }",
        "pub struct A; type C = Vec<Option<&'static dyn crate::b::B>>;",
    ] {
        assert_eq!(of_pair(a, "pub struct B(crate::a::A);"), CYCLE, "{a}");
    }
}

#[test]
fn tests_variables_and_other_crates_make_no_dependency() {
    for a in [
        "pub struct A; #[cfg(test)] mod tests { use crate::b::B; }",
        "pub struct A; #[cfg(test)] use crate::b::B;",
        "pub struct A; impl A { #[cfg(test)] fn f() -> crate::b::B { crate::b::B } }",
        "pub struct A; #[cfg(all(test, unix))] fn f(b: crate::b::B) {}",
        "use ::b::B; pub struct A(B);",
        "use other::b::B; pub struct A(B);",
        "use crate::b; pub struct A;",
        "use crate::b::*; pub struct A; fn f(limit: u32) -> u32 { g!(limit, x.limit()); limit }",
        "/// See [`crate::b::B`].\npub struct A;",
    ] {
        let b = "use crate::a::A; pub struct B(A); pub fn limit() {}";
        assert_eq!(of_pair(a, b), NONE, "{a}");
    }
}

#[test]
fn a_reexport_leads_to_the_definition() {
    let files = |root: &str, child: &str| {
        cycles(&[
            ("lib.rs", root),
            (
                "parent.rs",
                "mod child; pub use child::Child; pub struct Parent;",
            ),
            ("parent/child.rs", child),
            (
                "user.rs",
                "use crate::parent::Child; pub struct User(Child);",
            ),
        ])
    };
    let root = "mod parent; mod user; pub use parent::Parent;";
    assert_eq!(files(root, "pub struct Child(super::Parent);"), NONE);
    assert_eq!(files(root, "pub struct Child(crate::Parent);"), NONE);
    assert_eq!(
        files(root, "pub struct Child(crate::user::User);"),
        [
            "parent::child → user (User)",
            "user → parent::child (Child)"
        ]
    );
    let root = "mod parent; mod user; pub use parent::Parent; pub fn f() -> Parent { Parent }";
    assert_eq!(files(root, "pub struct Child; fn g() { crate::f() }"), NONE);
}

#[test]
fn a_parent_and_its_child_make_a_cycle_when_each_uses_the_other() {
    let cycle = [
        "parent → parent::child (g)",
        "parent::child → parent (Parent)",
    ];
    for parent in [
        "mod child; pub struct Parent; fn f() { child::g() }",
        "mod child; pub use child::g; pub struct Parent; fn f() { g() }",
        "mod child; use child::g; pub struct Parent;",
    ] {
        let found = cycles(&[
            ("lib.rs", "mod parent;"),
            ("parent/mod.rs", parent),
            (
                "parent/child.rs",
                "pub fn g() -> super::Parent { super::Parent }",
            ),
        ]);
        assert_eq!(found, cycle, "{parent}");
    }
}

#[test]
fn macros_count_by_order_of_text_and_by_export() {
    let root = "macro_rules! twice { ($x:expr) => { $x + $x } } mod a; fn f() { a::A::new() }";
    let a = "pub struct A; fn f() -> u32 { twice!(1) }";
    assert_eq!(
        cycles(&[("lib.rs", root), ("a.rs", a)]),
        ["crate → a (A)", "a → crate (twice!)"]
    );
    let b = "#[macro_export] macro_rules! twice { () => { 2 } } fn f(a: crate::a::A) {}";
    assert_eq!(
        of_pair("pub struct A; fn f() -> u32 { crate::twice!() }", b),
        ["a → b (twice!)", "b → a (A)"]
    );
}

#[test]
fn a_module_and_a_function_may_share_a_name() {
    let found = cycles(&[
        ("lib.rs", "mod render; mod size; pub use render::render;"),
        (
            "render.rs",
            "use crate::size::Size; pub struct Mode; pub fn render(_: Size) {}",
        ),
        ("size.rs", "pub struct Size(crate::render::Mode);"),
    ]);
    assert_eq!(found, ["render → size (Size)", "size → render (Mode)"]);
}

#[test]
fn only_the_dependencies_of_a_cycle_are_shown() {
    let files = [
        ("lib.rs", "mod a; mod b; mod c; mod d;"),
        ("a.rs", "pub fn a() { crate::b::b() }"),
        ("b.rs", "pub fn b() { crate::c::c() }"),
        ("c.rs", "pub fn c() { crate::a::a(); crate::d::d() }"),
        ("d.rs", "pub fn d() {}"),
    ];
    assert_eq!(cycles(&files), ["a → b (b)", "b → c (c)", "c → a (a)"]);
}

#[test]
fn imports_that_import_each_other_end() {
    assert_eq!(
        of_pair(
            "pub use crate::b::X;",
            "pub use crate::a::X; pub use crate::a::*;"
        ),
        NONE
    );
}

#[test]
fn reports_path_attributes_and_missing_files() {
    let tree = load(&[
        ("lib.rs", "#[path = \"../other/ports.rs\"] mod ports;"),
        ("../other/ports.rs", "pub struct Ports;"),
    ]);
    assert_eq!(tree.path_attributes, ["lib.rs: `#[path]` of ports"]);
    let read = |path: &Path| (path == Path::new("lib.rs")).then(|| "mod lost;".to_owned());
    let Err(error) = Crate::load(Path::new("lib.rs"), &read) else {
        panic!("loaded a crate without its file");
    };
    assert_eq!(error.to_string(), "lost.rs: no such file");
}
