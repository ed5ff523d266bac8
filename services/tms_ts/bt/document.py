"""A tree document with its includes: the trees in it, and the models of the editor's palette."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

from lxml import etree

from tms_reason.reason import Reason
from tms_reason.xml_text import MAX_BYTES, MAX_DEPTH
from tms_ts.bt.errors import MAX_WARNINGS, TreeError, shortened, within
from tms_ts.bt.source import ParsedXml, line_of, parse, read_file
from tms_ts.tree_reasons import (
    CannotInclude,
    IncludeCircle,
    IncludeNeedsPath,
    IncludeNoFolder,
    IncludeOutside,
    IncludeRosPkg,
    ManyIncludes,
    NestedTooDeep,
    NoBehaviorTree,
    NoMainTree,
    NotRoot,
    OneOf,
    TwoPalettes,
    TwoTrees,
    UsePath,
)

MAX_FILES = 50


@dataclass(slots=True)
class TreeElement:
    """One <BehaviorTree> and the document it stands in."""

    id: str
    element: etree._Element
    source: ParsedXml
    v4: bool


@dataclass(slots=True)
class Document:
    """What the files of one task hold, as elements with their places."""

    sources: list[ParsedXml] = field(default_factory=list)
    trees: list[TreeElement] = field(default_factory=list)  # all trees, in order of registration
    models: dict[str, frozenset[str]] = field(default_factory=dict)  # ID -> ports, by TreeNodesModel
    warnings: list[tuple[int, Reason]] = field(default_factory=list)
    errors: list[TreeError] = field(default_factory=list)  # of calls of templates
    places: dict[etree._Element, str] = field(default_factory=dict)  # of elements from templates: TEMPLATE:LINE
    templates: dict[str, str] = field(default_factory=dict)  # name -> text of those that it calls

    @property
    def warns(self) -> bool:
        """Whether further warnings are kept."""
        return len(self.warnings) < MAX_WARNINGS

    def warn(self, line: int, what: Reason) -> None:
        if self.warns:
            self.warnings.append((line, shortened(what)))

    def warn_at(self, element: etree._Element, what: Reason) -> None:
        """Warn of an element, which may come from a template."""
        self.warn(line_of(element), within(self.places.get(element, ""), what))

    def by_id(self) -> dict[str, TreeElement]:
        found: dict[str, TreeElement] = {}
        for tree in self.trees:
            found.setdefault(tree.id, tree)
        return found

    @property
    def main(self) -> str:
        """The ID of the tree to run."""
        wanted = self.sources[0].attributes(self.sources[0].root).get("main_tree_to_execute")
        ids = list(self.by_id())
        if wanted is None and len(ids) == 1:
            return ids[0]
        if wanted is None:
            hint = OneOf(tuple(ids)) if ids else NoBehaviorTree()
            raise TreeError(NoMainTree(), line=1, hint=hint)
        return wanted


def children(element: etree._Element) -> Iterator[etree._Element]:
    """The child elements, without comments and processing instructions."""
    return element.iterchildren("*")


def described(palette: Iterable[etree._Element]) -> Iterator[tuple[str, frozenset[str]]]:
    """The IDs and ports that a TreeNodesModel describes."""
    for element in palette:
        if isinstance(element.tag, str) and (name := element.get("ID")):
            ports = [port.get("name") for port in children(element) if str(port.tag).endswith("_port")]
            yield name, frozenset(str(port).strip() for port in ports if port)


def read(data: bytes | str, *, folder: Path | None = None, file: str = "", limit: int = MAX_BYTES) -> Document:
    """Read a document and its includes, which must stay inside `folder`."""
    document = Document()
    _DocumentReader(document, folder.resolve() if folder else None, limit).read(data, folder, file)
    return document


class _DocumentReader:
    def __init__(self, document: Document, folder: Path | None, limit: int) -> None:
        self.document = document
        self.folder = folder
        self.limit = limit
        self.open_files: list[Path] = []
        self.unnamed = 0

    def read(self, data: bytes | str, here: Path | None, file: str) -> None:
        source = parse(data, file=file, limit=self.limit)
        self.document.sources.append(source)
        if source.root.tag != "root":
            raise TreeError(NotRoot(str(source.root.tag)), line=line_of(source.root), file=file)
        check_depth(source)
        for child in children(source.root):
            if child.tag == "include":
                self.include(child, source, here)
        v4 = source.attributes(source.root).get("BTCPP_format", "").strip().startswith("4")
        self.trees(source, v4=v4)
        self.palette(source)

    def trees(self, source: ParsedXml, *, v4: bool) -> None:
        known = {tree.id for tree in self.document.trees}
        for child in children(source.root):
            if child.tag != "BehaviorTree":
                continue
            name = source.attributes(child).get("ID")
            if name is None:
                name, self.unnamed = f"BehaviorTree_{self.unnamed}", self.unnamed + 1
            if name in known:
                self.document.warn(line_of(child), TwoTrees(name))
            known.add(name)
            self.document.trees.append(TreeElement(name, child, source, v4))

    def palette(self, source: ParsedXml) -> None:
        models = [child for child in children(source.root) if child.tag == "TreeNodesModel"]
        if len(models) > 1:
            raise TreeError(TwoPalettes(), line=line_of(models[1]), file=source.file)
        for name, ports in described(models[0] if models else ()):
            self.document.models.setdefault(name, ports)

    def include(self, element: etree._Element, source: ParsedXml, here: Path | None) -> None:
        given = source.attributes(element)
        line, name = line_of(element), given.get("path", "")
        if "ros_pkg" in given:
            raise TreeError(IncludeRosPkg(), line=line, file=source.file, hint=UsePath())
        if not name:
            raise TreeError(IncludeNeedsPath(), line=line, file=source.file)
        if self.folder is None or here is None:
            raise TreeError(IncludeNoFolder(name), line=line, file=source.file)
        path = (here / name).resolve()
        if Path(name).is_absolute() or not path.is_relative_to(self.folder):
            raise TreeError(IncludeOutside(name), line=line, file=source.file)
        if path in self.open_files:
            raise TreeError(IncludeCircle(name), line=line, file=source.file)
        if len(self.document.sources) >= MAX_FILES:
            raise TreeError(ManyIncludes(MAX_FILES), line=line, file=source.file)
        self.open_files.append(path)
        try:
            data = read_file(path, self.limit)
        except TreeError as error:
            raise TreeError(CannotInclude(name, error.what), line=line, file=source.file) from error
        self.read(data, path.parent, name)
        self.open_files.pop()


def check_depth(source: ParsedXml) -> None:
    """Refuse deep nesting before anything recurses over it."""
    depth = 0
    for event, element in etree.iterwalk(source.root, events=("start", "end")):
        depth += 1 if event == "start" else -1
        if depth > MAX_DEPTH:
            raise TreeError(NestedTooDeep(MAX_DEPTH), line=line_of(element), file=source.file)
