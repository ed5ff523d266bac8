"""Models of what the editor of tasks draws with."""

from pydantic import Field

from tms_ur.base_model import Model


class Worker(Model):
    """A machine that leaves can ask."""

    name: str
    model: str
    subtasks: list[str] = Field(description="the names that leaves give")


class Palette(Model):
    """What a task can be made of."""

    xml: str = Field(description="a TreeNodesModel with every node of trees, empty until the scheduler has told; "
                     "builtin marks those that Groot knows without it")  # fmt: skip
    machines: list[Worker] = Field(description="of the site")


class TemplateText(Model):
    """The tree of a template."""

    xml: str = Field(description="the tree as Groot draws it")
