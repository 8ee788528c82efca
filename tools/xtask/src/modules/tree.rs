//! The module tree of one crate, and the names in each module's scope.

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow, bail};
use syn::{Attribute, Expr, ExprLit, Ident, Item, ItemMod, Lit, Meta, UseTree, Visibility};

/// Index of a module in [`Crate::modules`]; 0 is the crate's root.
pub type Id = usize;

/// Segments of a path, such as `crate`, `a` and `B` of `crate::a::B`.
pub type Segments = Vec<String>;

/// Reads the text of a source file; `None` if no such file exists.
pub type ReadSource<'a> = &'a dyn Fn(&Path) -> Option<String>;

/// One crate: its root module and all modules below the root.
pub struct Crate {
    /// Every module, including inline modules; the root is the first.
    pub modules: Vec<Module>,
    /// `#[path]` attributes, as `FILE: mod NAME`.
    pub path_attributes: Vec<String>,
}

/// One module, inline or in its own file.
pub struct Module {
    /// Path of the module below the root, such as `a::b`; `crate` for the root.
    pub name: String,
    /// The module that the whole file belongs to: for an inline module the one around it, otherwise the module itself.
    pub file_module: Id,
    /// Items of the module, without those under `#[cfg(test)]`.
    pub items: Vec<Item>,
    parent: Option<Id>,
    names: HashMap<String, Vec<Name>>,
    globs: Vec<Segments>,
}

/// One meaning of a name in a module's scope.
enum Name {
    /// An item defined in this module.
    Item(Id),
    /// A child module.
    Module(Id),
    /// An import. Its path is resolved when the name is looked up.
    Import(Segments),
}

/// What a path refers to.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub enum Definition {
    /// A module.
    Module(Id),
    /// An item, by the module that defines it and its name there.
    Item(Id, String),
}

/// One leaf of a `use` declaration.
pub struct Import {
    /// The imported path.
    pub path: Segments,
    /// Name of the item in the importing scope; `None` for a glob and for `_`.
    pub name: Option<String>,
    /// Whether the import is a glob, `path::*`.
    pub glob: bool,
}

impl Crate {
    /// Loads the crate with the root file `root`.
    ///
    /// # Errors
    /// A file is missing or cannot be parsed.
    pub fn load(root: &Path, read: ReadSource) -> Result<Self> {
        let mut tree = Self {
            modules: Vec::new(),
            path_attributes: Vec::new(),
        };
        let text = read(root).with_context(|| format!("{}: no such file", root.display()))?;
        let folder = root.parent().unwrap_or(Path::new("")).to_path_buf();
        tree.add_file(None, "crate", root, folder, &text, read)?;
        Ok(tree)
    }

    /// Adds the module in `file`, whose text is `text`. The files of its child modules are below `folder`.
    fn add_file(
        &mut self,
        parent: Option<Id>,
        name: &str,
        file: &Path,
        folder: PathBuf,
        text: &str,
        read: ReadSource,
    ) -> Result<Id> {
        let parsed =
            syn::parse_file(text).map_err(|error| anyhow!("{}: {error}", file.display()))?;
        let id = self.modules.len();
        self.add(parent, name, id, Place { file, folder }, parsed.items, read)
    }

    /// Adds a module with its items and child modules.
    fn add(
        &mut self,
        parent: Option<Id>,
        name: &str,
        file_module: Id,
        place: Place,
        items: Vec<Item>,
        read: ReadSource,
    ) -> Result<Id> {
        let id = self.modules.len();
        let items: Vec<Item> = items
            .into_iter()
            .filter(|item| !only_in_tests(attributes(item)))
            .collect();
        self.modules.push(Module {
            name: match parent {
                None | Some(0) => name.to_owned(),
                Some(parent) => format!("{}::{name}", self.modules[parent].name),
            },
            file_module,
            items: Vec::new(),
            parent,
            names: HashMap::new(),
            globs: Vec::new(),
        });
        for item in &items {
            match item {
                Item::Mod(module) => {
                    let child = self.add_child(id, module, &place, read)?;
                    self.name(id, &module.ident, Name::Module(child));
                }
                Item::Use(item) => {
                    for import in imports(&item.tree) {
                        if import.glob {
                            self.modules[id].globs.push(import.path);
                        } else if let Some(name) = import.name {
                            let names = &mut self.modules[id].names;
                            names
                                .entry(name)
                                .or_default()
                                .push(Name::Import(import.path));
                        }
                    }
                }
                Item::Macro(item) => {
                    if let Some(ident) = &item.ident {
                        self.name(id, ident, Name::Item(id));
                        if id != 0 && has_attribute(&item.attrs, "macro_export") {
                            self.name(0, ident, Name::Item(id));
                        }
                    }
                }
                item => {
                    if let Some(ident) = defined(item) {
                        self.name(id, ident, Name::Item(id));
                    }
                }
            }
        }
        self.modules[id].items = items;
        Ok(id)
    }

    fn name(&mut self, id: Id, ident: &Ident, meaning: Name) {
        self.modules[id]
            .names
            .entry(text(ident))
            .or_default()
            .push(meaning);
    }

    fn add_child(
        &mut self,
        parent: Id,
        module: &ItemMod,
        place: &Place,
        read: ReadSource,
    ) -> Result<Id> {
        let name = text(&module.ident);
        let folder = place.folder.join(&name);
        if let Some((_, items)) = &module.content {
            let place = Place { folder, ..*place };
            let file_module = self.modules[parent].file_module;
            return self.add(Some(parent), &name, file_module, place, items.clone(), read);
        }
        if let Some(path) = path_attribute(&module.attrs) {
            self.path_attributes
                .push(format!("{}: mod {name}", place.file.display()));
            let file = place.file.parent().unwrap_or(Path::new("")).join(path);
            let text = read(&file).with_context(|| format!("{}: no such file", file.display()))?;
            let folder = file.parent().unwrap_or(Path::new("")).to_path_buf();
            return self.add_file(Some(parent), &name, &file, folder, &text, read);
        }
        for file in [folder.with_extension("rs"), folder.join("mod.rs")] {
            if let Some(text) = read(&file) {
                return self.add_file(Some(parent), &name, &file, folder, &text, read);
            }
        }
        bail!("{}: mod {name}: no such file", place.file.display());
    }

    /// Whether `module` lies below `ancestor`.
    pub fn is_below(&self, module: Id, ancestor: Id) -> bool {
        let mut parent = self.modules[module].parent;
        while let Some(id) = parent {
            if id == ancestor {
                return true;
            }
            parent = self.modules[id].parent;
        }
        false
    }

    /// Returns the meanings of `path` in the scope of module `from`. Names of other crates, local variables and primitive types
    /// have none.
    pub fn resolve(&self, from: Id, path: &[String]) -> Vec<Definition> {
        self.resolve_guarded(from, path, &mut HashSet::new())
    }

    /// Returns the macro `name` that is defined in module `from` or in the nearest module above it: a macro by `macro_rules!` is
    /// visible in the child modules that follow it.
    pub fn textual_macro(&self, from: Id, name: &str) -> Option<Definition> {
        let mut next = Some(from);
        while let Some(id) = next {
            let is_macro = |item: &Item| matches!(item, Item::Macro(item) if item.ident.as_ref().is_some_and(|ident| ident == name));
            if self.modules[id].items.iter().any(is_macro) {
                return Some(Definition::Item(id, name.to_owned()));
            }
            next = self.modules[id].parent;
        }
        None
    }

    /// Resolves a path like [`Self::resolve`]. `seen` has the imports that are being resolved, and ends the search in a
    /// cycle of imports.
    fn resolve_guarded<'a>(
        &'a self,
        from: Id,
        path: &[String],
        seen: &mut HashSet<(Id, &'a [String])>,
    ) -> Vec<Definition> {
        let Some(first) = path.first() else {
            return Vec::new();
        };
        let mut start = match first.as_str() {
            "crate" => 0,
            "self" => from,
            "super" => match self.modules[from].parent {
                Some(parent) => parent,
                None => return Vec::new(),
            },
            _ => return self.descend(from, path, seen),
        };
        let mut rest = &path[1..];
        while let Some((segment, after)) = rest.split_first()
            && segment == "super"
        {
            let Some(parent) = self.modules[start].parent else {
                return Vec::new();
            };
            start = parent;
            rest = after;
        }
        self.descend(start, rest, seen)
    }

    /// Returns the meanings of `path`, whose first segment is a name in the scope of `module`.
    fn descend<'a>(
        &'a self,
        module: Id,
        path: &[String],
        seen: &mut HashSet<(Id, &'a [String])>,
    ) -> Vec<Definition> {
        let Some((name, rest)) = path.split_first() else {
            return vec![Definition::Module(module)];
        };
        let found = self.lookup(module, name, seen);
        if rest.is_empty() {
            return found;
        }
        let modules: Vec<Id> = found
            .iter()
            .filter_map(|target| match target {
                Definition::Module(id) => Some(*id),
                Definition::Item(..) => None,
            })
            .collect();
        if modules.is_empty() {
            // The name is that of a type, and the next segment a variant or an associated item.
            return found;
        }
        // A function may have the same name as a module, but only a module contains further names.
        modules
            .into_iter()
            .flat_map(|id| self.descend(id, rest, seen))
            .collect()
    }

    /// Returns the meanings of `name` in the scope of `module`. A name that the module defines or imports by itself hides the
    /// same name from a glob import.
    fn lookup<'a>(
        &'a self,
        module: Id,
        name: &str,
        seen: &mut HashSet<(Id, &'a [String])>,
    ) -> Vec<Definition> {
        let scope = &self.modules[module];
        let mut targets = Vec::new();
        if let Some(meanings) = scope.names.get(name) {
            for meaning in meanings {
                match meaning {
                    Name::Item(id) => targets.push(Definition::Item(*id, name.to_owned())),
                    Name::Module(id) => targets.push(Definition::Module(*id)),
                    Name::Import(path) => {
                        if seen.insert((module, path)) {
                            targets.extend(self.resolve_guarded(module, path, seen));
                            seen.remove(&(module, path.as_slice()));
                        }
                    }
                }
            }
            return targets;
        }
        for glob in &scope.globs {
            if seen.insert((module, glob)) {
                for target in self.resolve_guarded(module, glob, seen) {
                    if let Definition::Module(id) = target {
                        targets.extend(self.lookup(id, name, seen));
                    }
                }
                seen.remove(&(module, glob.as_slice()));
            }
        }
        targets
    }
}

/// A source file, and the folder that has the files of its child modules.
struct Place<'a> {
    file: &'a Path,
    folder: PathBuf,
}

/// The imports of a `use` declaration, one for each leaf of its tree.
pub fn imports(tree: &UseTree) -> Vec<Import> {
    let mut leaves = Vec::new();
    add_imports(tree, &mut Vec::new(), &mut leaves);
    leaves
}

fn add_imports(tree: &UseTree, prefix: &mut Segments, leaves: &mut Vec<Import>) {
    let mut leaf = |ident: &Ident, name: &Ident| {
        let mut path = prefix.clone();
        if ident != "self" || path.is_empty() {
            path.push(text(ident));
        }
        let name = match text(name).as_str() {
            "self" => path.last().cloned(),
            "_" => None,
            name => Some(name.to_owned()),
        };
        leaves.push(Import {
            path,
            name,
            glob: false,
        });
    };
    match tree {
        UseTree::Path(path) => {
            prefix.push(text(&path.ident));
            add_imports(&path.tree, prefix, leaves);
            prefix.pop();
        }
        UseTree::Name(name) => leaf(&name.ident, &name.ident),
        UseTree::Rename(rename) => leaf(&rename.ident, &rename.rename),
        UseTree::Glob(_) => leaves.push(Import {
            path: prefix.clone(),
            name: None,
            glob: true,
        }),
        UseTree::Group(group) => {
            for tree in &group.items {
                add_imports(tree, prefix, leaves);
            }
        }
    }
}

/// Returns the text of an identifier, without the `r#` of a raw identifier.
pub fn text(ident: &Ident) -> String {
    let text = ident.to_string();
    text.strip_prefix("r#").map(str::to_owned).unwrap_or(text)
}

/// Whether an import with this visibility can be seen outside its module.
pub fn is_reexport(visibility: &Visibility) -> bool {
    !matches!(visibility, Visibility::Inherited)
}

/// The name that an item defines in its module.
fn defined(item: &Item) -> Option<&Ident> {
    match item {
        Item::Const(item) => Some(&item.ident),
        Item::Enum(item) => Some(&item.ident),
        Item::Fn(item) => Some(&item.sig.ident),
        Item::Static(item) => Some(&item.ident),
        Item::Struct(item) => Some(&item.ident),
        Item::Trait(item) => Some(&item.ident),
        Item::TraitAlias(item) => Some(&item.ident),
        Item::Type(item) => Some(&item.ident),
        Item::Union(item) => Some(&item.ident),
        _ => None,
    }
}

/// The attributes of an item.
pub fn attributes(item: &Item) -> &[Attribute] {
    match item {
        Item::Const(item) => &item.attrs,
        Item::Enum(item) => &item.attrs,
        Item::ExternCrate(item) => &item.attrs,
        Item::Fn(item) => &item.attrs,
        Item::ForeignMod(item) => &item.attrs,
        Item::Impl(item) => &item.attrs,
        Item::Macro(item) => &item.attrs,
        Item::Mod(item) => &item.attrs,
        Item::Static(item) => &item.attrs,
        Item::Struct(item) => &item.attrs,
        Item::Trait(item) => &item.attrs,
        Item::TraitAlias(item) => &item.attrs,
        Item::Type(item) => &item.attrs,
        Item::Union(item) => &item.attrs,
        Item::Use(item) => &item.attrs,
        _ => &[],
    }
}

/// Whether the attributes restrict an item to test builds: `#[cfg(test)]`, `#[cfg(all(test, ...))]`.
pub fn only_in_tests(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| match &attribute.meta {
        Meta::List(list) if list.path.is_ident("cfg") => {
            let condition = list.tokens.to_string().replace(' ', "");
            condition == "test" || condition.starts_with("all(test,")
        }
        _ => false,
    })
}

fn has_attribute(attributes: &[Attribute], name: &str) -> bool {
    attributes
        .iter()
        .any(|attribute| attribute.meta.path().is_ident(name))
}

/// The file that an attribute `#[path = "..."]` names, if there is one.
fn path_attribute(attributes: &[Attribute]) -> Option<String> {
    attributes
        .iter()
        .find_map(|attribute| match &attribute.meta {
            Meta::NameValue(pair) if pair.path.is_ident("path") => match &pair.value {
                Expr::Lit(ExprLit {
                    lit: Lit::Str(path),
                    ..
                }) => Some(path.value()),
                _ => None,
            },
            _ => None,
        })
}
