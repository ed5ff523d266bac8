"""A site that is made up for the 3D picture: 20 machines that drive and dig on hills of 40,000 cells; no ROS."""

import math
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from bench.rig.feeding import fed
from browser.yard import Yard
from tms_ur.ground_models import Ground
from tms_ur.models import Joint, Machine, Place

SIDE = 200  # cells of 1 m
PERIOD = 0.1  # s between two states: what a console gets at most
ROUND = 0.05  # of its circle that a machine drives in a second
ANGLES = {"swing_joint": 1.5, "boom_joint": -0.6, "arm_joint": 1.6, "bucket_joint": 0.9, "vessel_pin_joint": -0.5}


class BigSite(Yard):
    """Ten excavators and ten carriers, each on a circle of its own."""

    def __init__(self) -> None:
        super().__init__(
            {f"{model}_{number}": model for model in ("zx200", "ic120") for number in range(10)}, ground={}
        )

    def ground(self, cells: int) -> Ground:
        heights: list[float | None] = [
            round(3 * math.sin(column / 17) * math.cos(row / 23) + 0.3 * math.sin(column * row), 2)
            for row in range(SIDE) for column in range(SIDE)
        ]  # fmt: skip
        return Ground(x0=-100.0, y0=-100.0, cell=1.0, rows=SIDE, columns=SIDE, heights=heights)

    def tell(self, seconds: float) -> None:
        """Where all machines are at a time."""
        self.now = 100.0 + seconds
        for number, (name, model) in enumerate(self.models.items()):
            turn = 2 * math.pi * ROUND * seconds + number
            x, y = 12 * (number % 5) - 24 + 4 * math.cos(turn), 12 * (number // 5) - 18 + 4 * math.sin(turn)
            self.board.put_place(name, Place(x=round(x, 2), y=round(y, 2), yaw=turn + math.pi / 2))
            kept = [one for one in ANGLES if (one == "vessel_pin_joint") == (model == "ic120")]
            joints = [
                Joint(name=one, position=ANGLES[one] * (1 + 0.3 * math.sin(turn * 5)), velocity=0.1) for one in kept
            ]
            self.board.put_machine(Machine(name=name, state="moving", joint_age=0.0, joints=joints))


@contextmanager
def big_site(folder: Path) -> Iterator[str]:
    """Its console, fed as by real machines; gives the address."""
    site = BigSite()

    def feed(leave: threading.Event) -> None:
        told = 0
        while not leave.wait(PERIOD):
            told += 1
            site.tell(told * PERIOD)

    site.tell(0.0)
    with fed(site, folder, feed) as address:
        yield address
