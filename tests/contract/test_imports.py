"""No module imports itself by way of others, also not inside a function or for types alone."""

import graphlib

import grimp

from conftest import PROJECT

PACKAGES = sorted(path.parent.name for path in (PROJECT / "services").glob("tms_*/__init__.py"))


def test_no_circles() -> None:
    graph = grimp.build_graph(*PACKAGES, cache_dir=None)
    imported = {module: sorted(graph.find_modules_directly_imported_by(module)) for module in sorted(graph.modules)}
    assert len(imported) > 10 * len(PACKAGES), "these are not the modules of the services"
    circle: list[str] = []
    try:
        graphlib.TopologicalSorter(imported).prepare()
    except graphlib.CycleError as error:
        circle = error.args[1]  # each is imported by the next one
    assert circle == [], f"{' <- '.join(circle)}: move what both ends need to a module below them"
