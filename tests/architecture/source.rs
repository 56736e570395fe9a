//! The crate as its modules, read with `syn`: product code only, with every path that it names.
//!
//! What `#[cfg(test)]` leaves out is left out here, wherever it stands in a file; whole files too.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use proc_macro2::{Delimiter, TokenStream, TokenTree};
use syn::parse::Parser;
use syn::punctuated::Punctuated;
use syn::visit::{self, Visit};
use syn::{Attribute, Item, Meta, Token, UseTree, Visibility};

/// A module without its tests.
#[derive(Clone, Debug, Default)]
pub struct Module {
    /// Names from the root of the crate; none for `lib.rs`.
    pub path: Vec<String>,
    /// Path of the file from the root of the package, with `/`.
    pub file: String,
    /// Names of the items that are defined here, modules among them.
    pub items: BTreeSet<String>,
    /// Name (or `*`) and path of what is imported for the whole module.
    pub imports: Vec<(String, Vec<String>)>,
    /// Every path that is named.
    pub names: Vec<Name>,
    /// Macros that are called, by the last segment of their path, and the lines.
    pub macros: Vec<(String, usize)>,
    /// Methods that are called, and the lines.
    pub methods: Vec<(String, usize)>,
    /// Names of closures that are local variables.
    pub closures: Vec<String>,
    /// Public structs, enums, traits and aliases.
    pub public_types: Vec<String>,
    /// Identifiers and literals, comments left out.
    pub words: Vec<String>,
}

/// A path as it is written, without generic arguments.
#[derive(Clone, Debug)]
pub struct Name {
    pub segments: Vec<String>,
    pub line: usize,
    /// `pub use`, which passes a name on and needs nothing itself.
    pub passed_on: bool,
}

/// The modules by their paths.
#[derive(Clone, Debug, Default)]
pub struct Crate {
    pub modules: BTreeMap<Vec<String>, Module>,
    /// Files that only tests compile.
    pub tests: BTreeSet<String>,
}

impl Crate {
    /// Follows the `mod` items from `src/lib.rs`; `files` are texts by their paths from the package's root.
    pub fn read(files: &BTreeMap<String, String>) -> Self {
        let mut all = Self::default();
        all.file(files, "src/lib.rs".into(), vec![], false);
        all
    }

    fn file(&mut self, files: &BTreeMap<String, String>, file: String, path: Vec<String>, tests: bool) {
        let text = files.get(&file).unwrap_or_else(|| panic!("no {file} for the module {path:?}"));
        let parsed = syn::parse_file(text).unwrap_or_else(|e| panic!("{file}: {e}"));
        if tests {
            self.tests.insert(file.clone());
        }
        self.module(files, file, path, &parsed.items, tests);
    }

    fn module(
        &mut self,
        files: &BTreeMap<String, String>,
        file: String,
        path: Vec<String>,
        items: &[Item],
        tests: bool,
    ) {
        let mut scan =
            Scan { module: Module { path: path.clone(), file: file.clone(), ..Module::default() } };
        for item in items {
            let Item::Mod(inner) = item else {
                scan.top(item);
                continue;
            };
            let tests = tests || inner.attrs.iter().any(for_tests_only);
            let name = inner.ident.to_string();
            let below = [path.clone(), vec![name.clone()]].concat();
            if !tests {
                scan.module.items.insert(name.clone());
            }
            match &inner.content {
                Some((_, items)) => self.module(files, file.clone(), below, items, tests),
                None => {
                    let place = place(files, &file, &name, &inner.attrs);
                    // Tests share a module with those beside `src/`.
                    if !tests || files.contains_key(&place) {
                        self.file(files, place, below, tests);
                    }
                }
            }
        }
        if !tests {
            self.modules.insert(path, scan.module);
        }
    }

    /// A path that is named in a module, from the root of the crate; `None` for one of another crate.
    pub fn absolute(&self, module: &[String], segments: &[String]) -> Option<Vec<String>> {
        self.resolved(module, segments, 8)
    }

    /// Names that are imported may be imported by names that are imported: `steps` of that are followed.
    fn resolved(&self, module: &[String], segments: &[String], steps: usize) -> Option<Vec<String>> {
        let (mut at, mut rest) = match segments.first()?.as_str() {
            "crate" => (vec![], &segments[1..]),
            "self" => (module.to_vec(), &segments[1..]),
            "super" => (module.to_vec(), segments),
            first => return self.local(module, first, segments, steps.checked_sub(1)?),
        };
        while let Some((first, more)) = rest.split_first().filter(|(first, _)| *first == "super") {
            debug_assert_eq!(first, "super");
            at.pop();
            rest = more;
        }
        at.extend_from_slice(rest);
        Some(at)
    }

    /// A path that begins with a module inside this one, or with a name that this one imports.
    fn local(
        &self,
        module: &[String],
        first: &str,
        segments: &[String],
        steps: usize,
    ) -> Option<Vec<String>> {
        let below = [module, &[first.to_string()]].concat();
        if self.modules.contains_key(&below) {
            return Some([module, segments].concat());
        }
        let here = self.modules.get(module)?;
        let (_, target) = here.imports.iter().find(|(alias, _)| alias == first)?;
        let target = target
            .first()
            .filter(|name| *name != first)
            .and_then(|_| self.resolved(module, target, steps))?;
        Some([&target, &segments[1..]].concat())
    }

    /// A path of another crate with its first name as it was imported: `io::stdout` is `std::io::stdout`.
    pub fn foreign(&self, module: &[String], segments: &[String]) -> Vec<String> {
        let imports = self.modules.get(module).map(|m| &m.imports).into_iter().flatten();
        let mut found = imports.filter(|(alias, target)| *alias == segments[0] && target.len() > 1);
        match found.next() {
            Some((_, target)) if segments.len() > 1 => [target, &segments[1..]].concat(),
            _ => segments.to_vec(),
        }
    }

    /// The module that defines what an absolute path names: names that others pass on are followed.
    pub fn definition(&self, path: &[String]) -> Option<&Module> {
        self.followed(path, 16)
    }

    fn followed(&self, path: &[String], steps: usize) -> Option<&Module> {
        let deepest = (0..=path.len()).rev().find_map(|n| self.modules.get(&path[..n]))?;
        let Some((name, more)) = path[deepest.path.len()..].split_first().filter(|_| steps > 0) else {
            return Some(deepest);
        };
        if deepest.items.contains(name) {
            return Some(deepest);
        }
        if let Some((_, target)) = deepest.imports.iter().find(|(alias, _)| alias == name) {
            let target = self.absolute(&deepest.path, target)?;
            return self.followed(&[target, more.to_vec()].concat(), steps - 1);
        }
        let globs = deepest.imports.iter().filter(|(alias, _)| alias == "*");
        let defining = |(_, target): &(String, Vec<String>)| {
            let target = self.absolute(&deepest.path, target)?;
            let found = self.modules.get(&target)?;
            let has = found.items.contains(name) || found.imports.iter().any(|(alias, _)| alias == name);
            has.then(|| self.followed(&[target, vec![name.clone()]].concat(), steps - 1))?
        };
        globs.into_iter().find_map(defining).or(Some(deepest))
    }

    /// The files that each file needs, itself left out.
    pub fn needs(&self) -> BTreeMap<&str, BTreeSet<&str>> {
        let mut needs: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
        for module in self.modules.values() {
            let needed = needs.entry(&module.file).or_default();
            for name in module.names.iter().filter(|n| !n.passed_on) {
                let found = self.absolute(&module.path, &name.segments).and_then(|p| self.definition(&p));
                needed.extend(found.map(|m| m.file.as_str()).filter(|f| *f != module.file));
            }
        }
        needs
    }
}

/// The texts of the `.rs` files below `src/` of this package.
pub fn files() -> BTreeMap<String, String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let (mut found, mut folders) = (BTreeMap::new(), vec![root.join("src")]);
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "rs") {
                found.insert(
                    slashed(path.strip_prefix(root).unwrap()),
                    std::fs::read_to_string(&path).unwrap(),
                );
            }
        }
    }
    found
}

fn slashed(path: &Path) -> String {
    path.iter().map(|part| part.to_str().unwrap()).collect::<Vec<_>>().join("/")
}

/// The file of `mod name;`.
fn place(files: &BTreeMap<String, String>, file: &str, name: &str, attrs: &[Attribute]) -> String {
    let path = PathBuf::from(file);
    let beside = path.parent().unwrap();
    let named = attrs.iter().find_map(|a| match &a.meta {
        Meta::NameValue(meta) if meta.path.is_ident("path") => Some(literal(&meta.value)),
        _ => None,
    });
    if let Some(named) = named {
        return slashed(&beside.join(named));
    }
    let stem = path.file_stem().unwrap().to_str().unwrap();
    let folder =
        if matches!(stem, "lib" | "mod" | "main") { beside.to_path_buf() } else { beside.join(stem) };
    let flat = slashed(&folder.join(format!("{name}.rs")));
    if files.contains_key(&flat) { flat } else { slashed(&folder.join(name).join("mod.rs")) }
}

fn literal(value: &syn::Expr) -> String {
    match value {
        syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Str(text), .. }) => text.value(),
        _ => panic!("a path that is no literal"),
    }
}

/// Whether an attribute leaves its item out of what is not a test.
fn for_tests_only(attribute: &Attribute) -> bool {
    let predicate = match &attribute.meta {
        Meta::List(list) if list.path.is_ident("cfg") => list.parse_args::<Meta>(),
        meta => return meta.path().is_ident("test"),
    };
    predicate.is_ok_and(|p| needs_test(&p))
}

fn needs_test(predicate: &Meta) -> bool {
    let Meta::List(list) = predicate else { return predicate.path().is_ident("test") };
    let parser = Punctuated::<Meta, Token![,]>::parse_terminated;
    let Ok(parts) = parser.parse2(list.tokens.clone()) else { return false };
    match list.path.get_ident().map(ToString::to_string).as_deref() {
        Some("all") => parts.iter().any(needs_test),
        Some("any") => !parts.is_empty() && parts.iter().all(needs_test),
        _ => false,
    }
}

/// Collects what the items of one module name.
struct Scan {
    module: Module,
}

impl Scan {
    /// An item of the module itself: its name and its imports count for the whole module.
    fn top(&mut self, item: &Item) {
        let Some((attrs, name)) = head(item) else { return self.visit_item(item) };
        if attrs.iter().any(for_tests_only) {
            return;
        }
        if let (Some(name), true) = (&name, is_public_type(item)) {
            self.module.public_types.push(name.clone());
        }
        self.module.items.extend(name);
        if let Item::Use(import) = item {
            for (alias, segments, _) in leaves(&import.tree) {
                self.module.imports.push((alias, segments));
            }
        }
        self.visit_item(item);
    }

    fn name(&mut self, segments: Vec<String>, line: usize, passed_on: bool) {
        self.module.names.push(Name { segments, line, passed_on });
    }

    /// Paths, macros and words in tokens that are not parsed: those of macros and attributes.
    fn tokens(&mut self, stream: TokenStream, before: &[String]) {
        let all: Vec<TokenTree> = stream.into_iter().collect();
        let is = |at: usize, c: char| matches!(all.get(at), Some(TokenTree::Punct(p)) if p.as_char() == c);
        let mut at = 0;
        while at < all.len() {
            match &all[at] {
                TokenTree::Ident(first) => {
                    let line = first.span().start().line;
                    let mut segments = before.to_vec();
                    while let Some(TokenTree::Ident(segment)) = all.get(at) {
                        segments.push(segment.to_string());
                        self.module.words.push(segment.to_string());
                        at += 1;
                        if !(is(at, ':') && is(at + 1, ':')) {
                            break;
                        }
                        at += 2;
                    }
                    if is(at, '!') && matches!(all.get(at + 1), Some(TokenTree::Group(_))) {
                        self.module.macros.push((segments.last().unwrap().clone(), line));
                    }
                    let inside = match all.get(at) {
                        Some(TokenTree::Group(g)) if g.delimiter() == Delimiter::Brace && is(at - 1, ':') => {
                            Some(g.stream())
                        }
                        _ => None,
                    };
                    if let Some(inside) = inside {
                        self.tokens(inside, &segments);
                        at += 1;
                    } else if segments.len() > 1 {
                        self.name(segments, line, false);
                    }
                }
                TokenTree::Group(group) => {
                    self.tokens(group.stream(), before);
                    at += 1;
                }
                TokenTree::Literal(literal) => {
                    self.module.words.push(literal.to_string());
                    at += 1;
                }
                TokenTree::Punct(_) => at += 1,
            }
        }
    }
}

/// Attributes and name of an item that may stand in a module.
fn head(item: &Item) -> Option<(&[Attribute], Option<String>)> {
    Some(match item {
        Item::Const(i) => (&i.attrs, Some(i.ident.to_string())),
        Item::Enum(i) => (&i.attrs, Some(i.ident.to_string())),
        Item::ExternCrate(i) => (&i.attrs, None),
        Item::Fn(i) => (&i.attrs, Some(i.sig.ident.to_string())),
        Item::Impl(i) => (&i.attrs, None),
        Item::Macro(i) => (&i.attrs, i.ident.as_ref().map(ToString::to_string)),
        Item::Static(i) => (&i.attrs, Some(i.ident.to_string())),
        Item::Struct(i) => (&i.attrs, Some(i.ident.to_string())),
        Item::Trait(i) => (&i.attrs, Some(i.ident.to_string())),
        Item::Type(i) => (&i.attrs, Some(i.ident.to_string())),
        Item::Use(i) => (&i.attrs, None),
        _ => return None,
    })
}

fn is_public_type(item: &Item) -> bool {
    let visibility = match item {
        Item::Enum(i) => &i.vis,
        Item::Struct(i) => &i.vis,
        Item::Trait(i) => &i.vis,
        Item::Type(i) => &i.vis,
        _ => return false,
    };
    matches!(visibility, Visibility::Public(_))
}

/// Name (or `*`), path and line of everything that a `use` imports.
fn leaves(tree: &UseTree) -> Vec<(String, Vec<String>, usize)> {
    let one = |alias: &syn::Ident, ident: &syn::Ident| {
        let path = if ident == "self" { vec![] } else { vec![ident.to_string()] };
        vec![(alias.to_string(), path, ident.span().start().line)]
    };
    match tree {
        UseTree::Path(p) => {
            let first = p.ident.to_string();
            let mut below = leaves(&p.tree);
            for (alias, segments, _) in &mut below {
                segments.insert(0, first.clone());
                if alias == "self" {
                    alias.clone_from(&first);
                }
            }
            below
        }
        UseTree::Name(n) => one(&n.ident, &n.ident),
        UseTree::Rename(r) => one(&r.rename, &r.ident),
        UseTree::Glob(g) => vec![("*".into(), vec![], g.star_token.spans[0].start().line)],
        UseTree::Group(g) => g.items.iter().flat_map(leaves).collect(),
    }
}

macro_rules! without_tests {
    ($($method:ident: $node:ident),* $(,)?) => {
        $(fn $method(&mut self, node: &'ast syn::$node) {
            if !node.attrs.iter().any(for_tests_only) {
                visit::$method(self, node);
            }
        })*
    };
}

impl<'ast> Visit<'ast> for Scan {
    without_tests! {
        visit_arm: Arm, visit_expr_block: ExprBlock, visit_expr_macro: ExprMacro,
        visit_field: Field, visit_field_value: FieldValue, visit_impl_item_const: ImplItemConst,
        visit_impl_item_fn: ImplItemFn, visit_impl_item_macro: ImplItemMacro,
        visit_impl_item_type: ImplItemType, visit_item_const: ItemConst, visit_item_enum: ItemEnum,
        visit_item_fn: ItemFn, visit_item_impl: ItemImpl,
        visit_item_macro: ItemMacro, visit_item_mod: ItemMod, visit_item_static: ItemStatic,
        visit_item_struct: ItemStruct, visit_item_trait: ItemTrait, visit_item_type: ItemType,
        visit_stmt_macro: StmtMacro, visit_trait_item_const: TraitItemConst,
        visit_trait_item_fn: TraitItemFn, visit_variant: Variant,
    }

    fn visit_local(&mut self, node: &'ast syn::Local) {
        if node.attrs.iter().any(for_tests_only) {
            return;
        }
        if let (syn::Pat::Ident(name), Some(init)) = (&node.pat, &node.init)
            && matches!(*init.expr, syn::Expr::Closure(_))
        {
            self.module.closures.push(name.ident.to_string());
        }
        visit::visit_local(self, node);
    }

    fn visit_item_use(&mut self, node: &'ast syn::ItemUse) {
        if node.attrs.iter().any(for_tests_only) {
            return;
        }
        let passed_on = !matches!(node.vis, Visibility::Inherited);
        for (_, segments, line) in leaves(&node.tree) {
            self.name(segments, line, passed_on);
        }
    }

    fn visit_item_extern_crate(&mut self, node: &'ast syn::ItemExternCrate) {
        if !node.attrs.iter().any(for_tests_only) {
            self.name(vec![node.ident.to_string()], node.ident.span().start().line, false);
        }
    }

    fn visit_path(&mut self, node: &'ast syn::Path) {
        let segments: Vec<_> = node.segments.iter().map(|s| s.ident.to_string()).collect();
        if segments.len() > 1 {
            self.name(segments, node.segments[0].ident.span().start().line, false);
        }
        visit::visit_path(self, node);
    }

    fn visit_macro(&mut self, node: &'ast syn::Macro) {
        let last = &node.path.segments.last().unwrap().ident;
        self.module.macros.push((last.to_string(), last.span().start().line));
        self.visit_path(&node.path);
        self.tokens(node.tokens.clone(), &[]);
    }

    fn visit_expr_method_call(&mut self, node: &'ast syn::ExprMethodCall) {
        self.module.methods.push((node.method.to_string(), node.method.span().start().line));
        visit::visit_expr_method_call(self, node);
    }

    /// `pub(in crate::a)` names no module that is used.
    fn visit_visibility(&mut self, _: &'ast Visibility) {}

    fn visit_attribute(&mut self, node: &'ast Attribute) {
        match &node.meta {
            Meta::NameValue(meta) if meta.path.is_ident("doc") => {}
            Meta::List(list) => self.tokens(list.tokens.clone(), &[]),
            meta => visit::visit_meta(self, meta),
        }
    }

    fn visit_ident(&mut self, node: &'ast syn::Ident) {
        self.module.words.push(node.to_string());
    }

    fn visit_lit_str(&mut self, node: &'ast syn::LitStr) {
        self.module.words.push(node.value());
    }
}
