"""The machines that a task moves, as the console names them before a start."""

from tms_ur.task_machines import machines_of

SITE = ("zx200", "ic120", "mst110")
TEMPLATES = {
    "Haul": "<root><L model_name='ic120'/><Action ID='ExecuteSubtask' subtask_name='Haul'/></root>",
    "Any": "<root><L model_name='$model_name$'/></root>",
}


def moved(body: str) -> list[str]:
    return machines_of(f"<root><Sequence>{body}</Sequence></root>", TEMPLATES.__getitem__, SITE)


def test_leaves_name_machines() -> None:
    assert moved("<L model_name='ic120'/><L model_name='zx200'/><L model_name='elsewhere'/>") == ["zx200", "ic120"]
    assert moved("<AlwaysSuccess/>") == []


def test_so_do_those_of_templates() -> None:
    call = "<Action ID='ExecuteSubtask' subtask_name='Haul'/>"  # which calls itself: the check refuses that, not this
    assert moved("<L model_name='zx200'/>" + call) == ["zx200", "ic120"]
    assert moved("<ExecuteSubtask subtask_name='Haul'/>") == ["ic120"]
    assert moved("<L subtask_name='Haul'/>") == []


def test_a_machine_that_is_known_late_may_be_any() -> None:
    assert moved("<L model_name='{machine}'/>") == list(SITE)
    assert moved("<ExecuteSubtask subtask_name='Any' model_name='zx200'/>") == list(SITE)


def test_text_that_is_no_tree_moves_nothing() -> None:
    assert machines_of("", TEMPLATES.__getitem__, SITE) == machines_of("no", TEMPLATES.__getitem__, SITE) == []
