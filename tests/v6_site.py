"""A site for the tasks of version 6 in tests/data, and what fills in the words in `$` of those that are templates."""

from typing import Any

from tms_config.config import CONFIGS
from tms_config.yaml_file import read_yaml
from v6_templates import TASKS

MACHINES = {"zx200": "zx200", "mst110cr": "mst110cr", "mst110cr_2": "mst110cr", "mst2200": "mst2200",
            "d37pxi_24": "d37pxi"}  # fmt: skip
RECORDS = ("shared", "zx200", "mst110cr", "mst2200", "d37pxi", "version6")  # files of configs/parameters
SECTIONS = [f"372596030000{number}" for number in range(5)]
WORDS = {
    "blade_tilt_1": "blade_tilt_1",
    "blade_tilt_2": "blade_tilt_2",
    "leveling_time": "5",
    "model_name": "mst110cr",
    "machine_record_name": "SAMPLE_BLACKBOARD_mst110cr",
    "start_status": SECTIONS[0],
    "terminate_condition": SECTIONS[3],
    "dump_up_angle": "RELEASE_ANGLE_UP",
    "dump_down_angle": "RELEASE_ANGLE_DOWN",
    "time": "5000",
    "release_area_data": "SAMPLE_BLACKBOARD_d37pxi",
    "block_point": "block_0",
    "stop_point": "stop_0",
    "loading_point": "loading_point",
    "after_loading_point": "after_loading_point",
    "swing_angle_for_loading": "SWING_ANGLE_LEFT",
    "swing_angle_for_runing": "SWING_ANGLE_FRONT",
    "arrival_flg_record_name": "SAMPLE_BLACKBOARD_mst110cr",
    "loaded_flg_record_name": "mst110cr",
}
EXCAVATOR = {"model_name": "zx200"} | {f"excavate{number}": f"target_excavate_pose_{number}" for number in (1, 2, 3)}


def filled(file: str) -> str:
    """The text of a task, or of a template as a task would call it."""
    text = (TASKS / f"{file}.xml").read_text(encoding="utf-8")
    for word, value in {**WORDS, **(EXCAVATOR if "Excavator" in file else {})}.items():
        text = text.replace(f"${word}$", value)
    return text


def records() -> list[dict[str, Any]]:
    """All records of the site."""
    return [dict(record) for name in RECORDS for record in read_yaml(CONFIGS / "parameters" / f"{name}.yaml")]
