"""A site of four PCs: work across them, and what the loss of a PC, a cable, a process or the store does."""

import json
import os
import signal
import statistics
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from docker_site import LOOK, Yard, cable, commanded, docker, in_network_of, stamp

from conftest import wait_until
from lateness import Lateness
from prometheus_server import processes_up, prometheus, query

pytestmark = [pytest.mark.docker, pytest.mark.timeout(400, func_only=True)]
LOSS = 0.7  # s from the loss of a process, a PC or a cable to the command that stops the machine (design, section 9)
PRESS = 0.05  # s from the press of the software stop to that command
LOSSY = """table inet bad {
  chain input { type filter hook input priority 0; iifname "eth0" numgen random mod 100 < 5 drop; }
  chain output { type filter hook output priority 0; oifname "eth0" numgen random mod 100 < 5 drop; }
}"""
CHANGE_POSE = "zx200:subtask_zx200_change_pose"


@pytest.fixture(autouse=True)
def whole(yard: Yard) -> None:
    """A test that failed must not fail the others, too."""
    for pc in yard.address:
        docker("start", yard.name(pc))
        yard.wait_ready(pc)
    yard.rearm()


def recovered(yard: Yard) -> None:
    """The site is whole and works again."""
    for pc in ("cps", "machine", "sim"):
        yard.wait_ready(pc)
    yard.rearm()
    answers = []
    wait_until(lambda: answers.append(yard.run("1")) or answers[-1]["outcome"] == "success", 90, f"works: {answers}")


def stopped_by(yard: Yard, loss: Callable[[], object], what: str) -> None:
    """The machine is commanded to stop in time after a loss, and seen to stand; both figures are printed."""
    yard.wait_moving()
    new: list[str] = []  # the gateway's own stops; one that a dying scheduler still asks for does not count

    def latched() -> bool:
        new[:] = [line for line in yard.stops() if stamp(line) > hit and "latched=True" in line]
        return bool(new)

    with Lateness().watched() as late:
        hit = time.time()
        loss()
        wait_until(latched, 30, "a receipt of the gateway", LOOK)
    took, stood = commanded(new[0]) - hit, stamp(new[0]) - hit
    print(f"{what}: stop commanded after {took:.3f} s, stands after {stood:.3f} s, this PC was {late.most:.3f} s late")
    assert "confirmed=True" in new[0], new
    assert took < LOSS + late.most
    assert yard.metric("zx200:rc", "tms_rc_latched") == 1.0


def test_a_task_runs_across_the_containers(yard: Yard) -> None:
    assert yard.run("1")["outcome"] == "success"


def test_a_subtask_is_restarted_inside_its_container_during_a_run(yard: Yard) -> None:
    run = yard.begin("1")
    yard.wait_moving()
    yard.tms("machine", "restart", CHANGE_POSE)
    out, err = run.communicate(timeout=120)
    assert json.loads(out)["outcome"] == "success", err


def test_a_frozen_process_is_restarted_inside_its_container(yard: Yard) -> None:
    """Its host agent asks it at the address of its PC."""
    rows = json.loads(yard.tms("machine", "ps", "--json").stdout)
    pid = next(row["pid"] for row in rows if row["name"] == "zx200:rp")
    docker("exec", yard.name("machine"), "sh", "-c", f"kill -STOP {pid}")
    wait_until(lambda: any("event=frozen target=zx200:rp" in line for line in yard.log("machine", "tms:host_machine")),
               60, "the host agent restarts it", LOOK)  # fmt: skip
    recovered(yard)


def test_the_software_stop_reaches_the_machine_pc_in_time(yard: Yard) -> None:
    with Lateness().watched() as late:
        reported = docker("exec", yard.name("cps"), "python3", "/tools/press.py", "zx200", "20").stdout
    waits = json.loads(reported)
    print(f"press -> stop commanded: median {statistics.median(waits):.4f} s, most {max(waits):.4f} s")
    assert max(waits) < PRESS + late.most
    recovered(yard)


def test_a_machine_whose_scheduler_is_cut_off_is_seen_to_stop(yard: Yard) -> None:
    run, pid = yard.begin("2"), yard.pid("cps")
    try:
        stopped_by(yard, lambda: cable(pid, out=True), "cable of the cps PC")
    finally:
        cable(pid, out=False)
    run.communicate(timeout=90)
    recovered(yard)


def test_a_machine_whose_cps_pc_dies_is_seen_to_stop_and_the_run_is_interrupted(yard: Yard) -> None:
    run, pid = yard.begin("2"), yard.pid("cps")
    stopped_by(yard, lambda: os.kill(pid, signal.SIGKILL), "power of the cps PC")
    run.communicate(timeout=90)
    docker("wait", yard.name("cps"))
    docker("start", yard.name("cps"))
    yard.wait_ready("cps")
    newest = lambda: json.loads(yard.tms("cps", "runs", "--limit", "1", "--json").stdout)[0]  # noqa: E731
    wait_until(lambda: newest()["state"] == "interrupted", 60, "the run is closed when its gateways have told")
    yard.rearm()
    yard.tms("cps", "abandon", newest()["run_id"])
    recovered(yard)


def test_the_run_ends_when_the_machine_pc_is_gone_and_works_when_it_is_back(yard: Yard) -> None:
    run = yard.begin("2")
    yard.wait_moving()
    docker("kill", yard.name("machine"))
    out, _ = run.communicate(timeout=120)
    assert json.loads(out)["outcome"] in ("failure", "stop_unconfirmed")
    docker("start", yard.name("machine"))
    recovered(yard)


def test_a_bad_cable_stops_no_work(yard: Yard) -> None:
    """5 % of the messages to and from the cps PC are lost, and late where the kernel can do that."""
    undo, how = spoilt(yard.pid("cps"))
    print(f"a bad cable: {how}")
    try:
        assert yard.run("1")["outcome"] == "success"
    finally:
        undo()


def spoilt(pid: int) -> tuple[Callable[[], object], str]:
    """Spoil the cable of a PC: how to mend it, and what was done."""
    argv = "tc qdisc add dev eth0 root netem delay 40ms 10ms loss 5%".split()
    if (tried := in_network_of(pid, *argv)).returncode == 0:
        return lambda: in_network_of(pid, "tc", "qdisc", "del", "dev", "eth0", "root"), " ".join(argv[-5:])
    made = in_network_of(pid, "nft", LOSSY)
    if made.returncode:
        pytest.skip(f"the kernel has neither netem ({tried.stderr.strip()}) nor numgen ({made.stderr.strip()})")
    return lambda: in_network_of(pid, "nft", "delete table inet bad"), (
        f"loss 5% each way by nft, no delay, for the kernel has no netem ({tried.stderr.strip()})"
    )


def test_a_lost_store_stops_no_work(yard: Yard) -> None:
    run = yard.begin("1")
    yard.wait_moving()
    yard.tms("cps", "stop-process", "tms:store")
    wait_until(lambda: yard.metric("tms:db", "tms_db_store_up") == 0.0, 30, "seen by db", LOOK)
    yard.tms("cps", "start", "tms:store")
    out, err = run.communicate(timeout=120)
    assert json.loads(out)["outcome"] == "success", err


def test_the_cps_pc_is_restarted_while_nothing_runs(yard: Yard) -> None:
    docker("restart", "--time", "25", yard.name("cps"), limit=90)
    state = docker("inspect", "--format", "{{.State.OOMKilled}} {{.State.Running}}", yard.name("cps")).stdout.split()
    assert state == ["false", "true"]
    recovered(yard)


def test_prometheus_sees_every_pc_and_tells_which_one_is_gone(yard: Yard, tmp_path: Path) -> None:
    docker("cp", f"{yard.name('cps')}:/var/lib/tms/prometheus/.", str(tmp_path))
    wanted = {row.full for row in yard.rows if row.ours and row.autostart}
    with prometheus(tmp_path, 9199) as address:
        wait_until(lambda: processes_up(address) >= wanted, 60, f"scraped: all of {sorted(wanted)}")
        assert query(address, 'min_over_time(up{on_demand="no"}[5s]) == 0') == []
        docker("kill", yard.name("sensing"))
        firing = 'ALERTS{alertname="TmsProcessDown", alertstate="firing"}'
        try:
            wait_until(lambda: bool(query(address, firing)), 60, "an alert fires")
            assert {row["metric"]["pc"] for row in query(address, firing)} == {"sensing"}
        finally:
            docker("start", yard.name("sensing"))
        wait_until(lambda: not query(address, firing), 60, "the alert is over")
