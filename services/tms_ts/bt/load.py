"""The two entry points: `load` makes a tree, `check` only reports content and errors of a document."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from itertools import islice
from pathlib import Path
from typing import Any

from tms_reason.reason import Reason
from tms_reason.xml_text import MAX_BYTES
from tms_ts.bt.advice import advise
from tms_ts.bt.blackboard import Blackboard
from tms_ts.bt.build import Builder
from tms_ts.bt.context import Context
from tms_ts.bt.document import Document, read
from tms_ts.bt.errors import TreeError
from tms_ts.bt.expand import Templates, expand, no_templates
from tms_ts.bt.node import Node
from tms_ts.bt.registry import Registry
from tms_ts.bt.registry import registry as all_nodes
from tms_ts.bt.source import read_file
from tms_ts.bt.tree import LeafGoal, Tree
from tms_ts.bt.verify import Rules
from tms_ts.world import World

MAX_ERRORS = 100  # more are no help to the author


def load(
    tree: str | bytes | Path,
    *,
    registry: Registry | None = None,
    world: World | None = None,
    blackboard: Mapping[str, Any] | None = None,
    folder: Path | None = None,
    templates: Templates = no_templates,
    clock: Callable[[], float] | None = None,
    quirks: bool = False,
    limit: int = MAX_BYTES,
) -> Tree:
    """Make a tree from text, or from a file if `tree` is a Path; the first error of the document is raised.

    folder: includes are looked for here and nowhere else (default: the file's own folder; none for text)
    templates: text by name of the templates that ExecuteSubtask calls
    quirks: copy the known defects of the C library too (a halted Timeout forgets to clear its timer)
    """
    document = _read(tree, folder, limit)
    expand(document, templates)
    rules = Rules(document, registry or all_nodes())
    error = next(rules.errors(), None)
    if error is not None:
        raise error
    return _build(document, rules, Context(world, clock, quirks=quirks), blackboard)


def _read(tree: str | bytes | Path, folder: Path | None, limit: int) -> Document:
    if isinstance(tree, Path):
        return read(read_file(tree, limit), folder=folder or tree.parent, file=tree.name, limit=limit)
    return read(tree, folder=folder, limit=limit)


def _build(document: Document, rules: Rules, context: Context[Node], values: Mapping[str, Any] | None) -> Tree:
    outermost = Blackboard()
    for key, value in (values or {}).items():
        outermost.set(key, value)
    builder = Builder(document, rules, context)
    root = builder.build(outermost)
    advise(builder.nodes)
    for line, what in document.warnings:  # last: warnings of unused trees must leave room for those of used ones
        context.warn(line, what)
    return Tree(root, builder.nodes, builder.blackboards, context, document)


@dataclass(slots=True)
class CheckReport:
    """What `check` found, without a run."""

    goals: list[LeafGoal] = field(default_factory=list)
    warnings: list[tuple[int, Reason]] = field(default_factory=list)
    errors: list[TreeError] = field(default_factory=list)
    nodes: int = 0

    @property
    def ok(self) -> bool:
        return not self.errors


def check(
    tree: str | bytes | Path,
    *,
    registry: Registry | None = None,
    folder: Path | None = None,
    templates: Templates | None = no_templates,
    cpp: bool = False,
    limit: int = MAX_BYTES,
) -> CheckReport:
    """Load without running: leaf goals, warnings and all errors with their lines.

    templates: None where nobody can be asked for them; calls are then not looked into
    cpp: a $key$ of a template that has no value becomes the word none, with a warning
    """
    report = CheckReport()
    try:
        document = _read(tree, folder, limit)
        expand(document, templates, cpp=cpp)
        rules = Rules(document, registry or all_nodes())
        report.errors.extend(islice(rules.errors(), MAX_ERRORS))
        report.warnings = list(document.warnings)
        if report.ok:
            loaded = _build(document, rules, Context(None), None)
            report.goals, report.warnings = loaded.leaf_goals(), loaded.warnings
            report.errors.extend(islice(loaded.faults, MAX_ERRORS))
            report.nodes = len(loaded.nodes)
    except TreeError as error:
        report.errors.append(error)
    return report
