//! The arrows of a crate: for each module, the items of other modules that it names.

use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

use proc_macro2::{TokenStream, TokenTree};
use syn::visit::{self, Visit};
use syn::{
    Attribute, Block, ImplItemFn, Item, ItemMacro, ItemUse, Macro, Meta, PatIdent, Path, Stmt,
};

use super::tree::{self, Crate, Definition, Id, Segments};

/// For each arrow (from, to), the names of the items in module `to` that module `from` uses.
pub type Arrows = BTreeMap<(Id, Id), BTreeSet<String>>;

/// Collects the arrows between the file modules of a crate.
pub fn arrows(tree: &Crate) -> Arrows {
    let mut arrows = Arrows::new();
    for (id, module) in tree.modules.iter().enumerate() {
        let mut collector = Collector {
            tree,
            module: id,
            bindings: HashSet::new(),
            blocks: Vec::new(),
            arrows: &mut arrows,
        };
        for item in &module.items {
            collector.item(item);
        }
    }
    arrows
}

/// Collects the arrows of one module from its items.
struct Collector<'a> {
    tree: &'a Crate,
    module: Id,
    /// Variables and parameters of the current item. A path that is just one of these names does not lead to an item.
    bindings: HashSet<String>,
    /// Imports of the code blocks around the current expression, the outermost block first.
    blocks: Vec<HashMap<String, Segments>>,
    arrows: &'a mut Arrows,
}

impl Collector<'_> {
    /// Collects the arrows of an item at the module's top level.
    fn item(&mut self, item: &Item) {
        // Child modules have their own collector.
        if matches!(item, Item::Mod(_)) {
            return;
        }
        let mut bindings = Bindings(HashSet::new());
        bindings.visit_item(item);
        self.bindings = bindings.0;
        self.visit_item(item);
    }

    fn arrow(&mut self, target: &Definition) {
        if let Definition::Item(definer, name) = target {
            let ends = [self.module, *definer].map(|id| self.tree.modules[id].file_module);
            if ends[0] != ends[1] {
                self.arrows
                    .entry(ends.into())
                    .or_default()
                    .insert(name.clone());
            }
        }
    }

    /// Adds the arrow for a path, as resolved in the scope of the module and of the blocks around the path.
    fn path(&mut self, path: &[String]) {
        let Some(first) = path.first() else { return };
        if path.len() == 1 && self.bindings.contains(first) {
            return;
        }
        let import = self.blocks.iter().rev().find_map(|names| names.get(first));
        let targets = match import {
            Some(import) => {
                let whole: Segments = import.iter().chain(&path[1..]).cloned().collect();
                self.tree.resolve(self.module, &whole)
            }
            None => self.tree.resolve(self.module, path),
        };
        for target in &targets {
            self.arrow(target);
        }
    }

    /// Collects the paths in the arguments of a macro or attribute, which syn leaves as tokens. With `absolute`, only paths that
    /// start with `crate` or `$crate` count.
    fn tokens(&mut self, tokens: TokenStream, absolute: bool) {
        let mut path = Segments::new();
        // What the last tokens were: after a single `.`, the next name is a field or a method; after `::` it continues the path.
        let (mut colons, mut dot) = (0, false);
        for token in tokens {
            match token {
                TokenTree::Ident(ident) => {
                    if colons != 2 {
                        self.token_path(&mut path, absolute);
                    }
                    if !dot {
                        path.push(tree::text(&ident));
                    }
                    (colons, dot) = (0, false);
                }
                TokenTree::Punct(punct) if punct.as_char() == ':' => colons += 1,
                TokenTree::Punct(punct) => {
                    self.token_path(&mut path, absolute);
                    (colons, dot) = (0, punct.as_char() == '.' && !dot);
                }
                TokenTree::Group(group) => {
                    self.token_path(&mut path, absolute);
                    (colons, dot) = (0, false);
                    self.tokens(group.stream(), absolute);
                }
                TokenTree::Literal(_) => {
                    self.token_path(&mut path, absolute);
                    (colons, dot) = (0, false);
                }
            }
        }
        self.token_path(&mut path, absolute);
    }

    fn token_path(&mut self, path: &mut Segments, absolute: bool) {
        if !absolute || path.first().is_some_and(|first| first == "crate") {
            self.path(path);
        }
        path.clear();
    }
}

impl<'ast> Visit<'ast> for Collector<'_> {
    fn visit_item(&mut self, item: &'ast Item) {
        if !tree::only_in_tests(tree::attributes(item)) {
            visit::visit_item(self, item);
        }
    }

    fn visit_impl_item_fn(&mut self, item: &'ast ImplItemFn) {
        if !tree::only_in_tests(&item.attrs) {
            visit::visit_impl_item_fn(self, item);
        }
    }

    /// Adds the arrow of an import. A re-export of an item from a child module makes no arrow, because the re-exporting module
    /// does not use the item.
    fn visit_item_use(&mut self, item: &'ast ItemUse) {
        for import in tree::imports(&item.tree) {
            for target in self.tree.resolve(self.module, &import.path) {
                let from_below = matches!(&target, Definition::Item(definer, _) if self.tree.is_below(*definer, self.module));
                if !(from_below && tree::is_reexport(&item.vis)) {
                    self.arrow(&target);
                }
            }
        }
    }

    fn visit_block(&mut self, block: &'ast Block) {
        let mut names = HashMap::new();
        for statement in &block.stmts {
            if let Stmt::Item(Item::Use(item)) = statement {
                for import in tree::imports(&item.tree) {
                    if let Some(name) = import.name {
                        names.insert(name, import.path);
                    }
                }
            }
        }
        self.blocks.push(names);
        visit::visit_block(self, block);
        self.blocks.pop();
    }

    fn visit_path(&mut self, path: &'ast Path) {
        if path.leading_colon.is_none() {
            let segments: Segments = path
                .segments
                .iter()
                .map(|segment| tree::text(&segment.ident))
                .collect();
            self.path(&segments);
        }
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, call: &'ast Macro) {
        if let Some(name) = call.path.get_ident()
            && let Some(target) = self.tree.textual_macro(self.module, &tree::text(name))
        {
            self.arrow(&target);
        }
        self.visit_path(&call.path);
        self.tokens(call.tokens.clone(), false);
    }

    /// Collects the paths of a macro. In a definition by `macro_rules!`, relative paths belong to the macro's callers, so only
    /// paths from `$crate` count for this module.
    fn visit_item_macro(&mut self, item: &'ast ItemMacro) {
        if item.ident.is_some() {
            self.tokens(item.mac.tokens.clone(), true);
        } else {
            self.visit_macro(&item.mac);
        }
    }

    /// Collects the paths in the arguments of an attribute, such as `#[clap(value_parser = super::parse)]`. The attribute's name
    /// is left out, because it is defined in another crate.
    fn visit_attribute(&mut self, attribute: &'ast Attribute) {
        match &attribute.meta {
            Meta::List(list) => self.tokens(list.tokens.clone(), false),
            Meta::NameValue(pair) => self.visit_expr(&pair.value),
            Meta::Path(_) => {}
        }
    }
}

/// The names of the variables that patterns bind.
struct Bindings(HashSet<String>);

impl<'ast> Visit<'ast> for Bindings {
    fn visit_pat_ident(&mut self, pattern: &'ast PatIdent) {
        let name = tree::text(&pattern.ident);
        // In a pattern, a name that starts with a capital letter is a constant or a variant, not a new variable.
        if !name.starts_with(char::is_uppercase) {
            self.0.insert(name);
        }
        visit::visit_pat_ident(self, pattern);
    }
}
