"""`tms` itself: help without ROS, exit codes, one line for an error."""

import json
import os
import subprocess
import sys
from pathlib import Path

import click
import pytest

from tms_cli import main

VERBS = (
    "abandon", "answer", "cancel", "check", "completion", "db", "demo", "drill", "events", "import", "logs", "palette",
    "panel", "param", "rearm", "resume", "run", "runs", "stop", "task", "template", "terrain", "user",
)  # fmt: skip


def tms(*words: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "tms_cli.main", *words],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=30,
        check=False,
    )


def test_help_lists_the_verbs_and_loads_no_ros() -> None:
    code = (
        "import sys; sys.argv = ['tms', '--help']\n"
        "from tms_cli import main\n"
        "try: main.main()\n"
        "except SystemExit as end: assert not end.code\n"
        "print([name for name in sys.modules if name.split('.')[0] in ('rclpy', 'rich', 'tms_msg_db')])\n"
    )
    end = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=30, check=True)
    assert end.stdout.splitlines()[-1] == "[]"
    for verb in VERBS:
        assert f"\n  {verb} " in end.stdout


def test_every_verb_has_help_with_an_example() -> None:
    from click.testing import CliRunner

    from tms_cli.main import tms as group

    for verb in VERBS:
        shown = CliRunner().invoke(group, [verb, "--help"]).output
        assert "Example" in shown, verb


def test_what_the_system_refuses_is_one_line_and_exit_code_1() -> None:
    end = tms("user", "add", "logger", "--role", "viewer", "--token", "--file", "/proc/users.yaml")  # also as root
    assert (end.returncode, end.stdout) == (1, "")
    (line,) = end.stderr.splitlines()
    assert line.startswith("tms: /proc/users.new: ") and "Choose another place" in line


@pytest.mark.parametrize(
    ("error", "reported"),
    [
        (TimeoutError("timed out"), "timed out; See what is wrong"),
        (OSError(), "OSError; See what is wrong"),
    ],
)
def test_what_the_system_refuses_without_naming_a_file(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], error: OSError, reported: str
) -> None:
    def fails(**_: object) -> None:
        raise error

    monkeypatch.setattr(main, "tms", fails)
    with pytest.raises(SystemExit) as end:
        main.main()
    assert end.value.code == 1
    assert capsys.readouterr().err.startswith(f"tms: {reported}")


@pytest.mark.parametrize("locale", ["C.UTF-8", "ja_JP.UTF-8"])
def test_a_question_that_nobody_can_answer_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, locale: str
) -> None:
    monkeypatch.setenv("LC_ALL", locale)
    end = tms("user", "add", "mina", "--role", "viewer", "--file", str(tmp_path / "users.yaml"))
    assert end.returncode == 1
    line = end.stderr.splitlines()[-1]
    assert "docker exec -it" in line and "--yes" in line
    assert ("何も行っていません" if locale.startswith("ja") else "nothing was done") in line
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("answer", [KeyboardInterrupt, None])
def test_ctrl_c_and_no_are_an_interruption_without_words(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], answer: type[BaseException] | None
) -> None:
    def ask(**_: object) -> None:
        click.confirm("Is it safe?", abort=True, err=True)

    def answered(_: str) -> str:
        if answer:
            raise answer
        return "n"

    monkeypatch.setattr(main, "tms", ask)
    monkeypatch.setattr(click.termui, "visible_prompt_func", answered)
    with pytest.raises(SystemExit) as end:
        main.main()
    assert end.value.code == 130
    assert "nothing was done" not in capsys.readouterr().err


def test_wrong_usage_is_exit_code_2() -> None:
    end = tms("task", "nonsense")
    assert end.returncode == 2
    assert "Traceback" not in end.stderr


def test_an_error_is_one_line_and_exit_code_1() -> None:
    end = tms("task", "add", "/nowhere/task.xml")
    assert (end.returncode, end.stdout) == (1, "")
    (line,) = end.stderr.splitlines()
    assert line.startswith("tms: /nowhere/task.xml: cannot be read")


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_completion(shell: str) -> None:
    done = tms("completion", shell)
    assert done.returncode == 0
    assert "_TMS_COMPLETE" in done.stdout
    environment = {**os.environ, "_TMS_COMPLETE": "bash_complete", "COMP_WORDS": "tms rea", "COMP_CWORD": "1"}
    found = subprocess.run(
        [str(Path(sys.executable).parent / "tms")],
        env=environment,
        capture_output=True,
        text=True,
        timeout=30,
        check=False,
    )
    assert "plain,rearm" in found.stdout


def test_no_colours_off_a_terminal() -> None:
    done = tms("check")
    assert "\x1b[" not in done.stdout + done.stderr


def test_users_are_kept_as_hashes(tmp_path: Path) -> None:
    from click.testing import CliRunner

    from tms_cli.main import tms as group
    from tms_ur.access import Access

    file = str(tmp_path / "users.yaml")
    run = CliRunner().invoke
    words = ["user", "add", "mina", "--role", "operator", "--file", file]
    assert run(group, words, input="long-enough\nlong-enough\n").exit_code == 0
    made = run(group, ["user", "add", "logger", "--role", "viewer", "--token", "--file", file, "--json"])
    token = json.loads(made.stdout)["token"]
    text = Path(file).read_text()
    assert "long-enough" not in text
    assert token.partition(":")[2] not in text
    assert Path(file).stat().st_mode & 0o777 == 0o600
    access = Access(Path(file))
    assert access.login("mina", "long-enough", "here")[1].role == "operator"
    assert access.token(token, "here").name == "logger"
    assert [row["name"] for row in json.loads(run(group, ["user", "list", "--file", file, "--json"]).stdout)] == [
        "logger", "mina",
    ]  # fmt: skip
    assert run(group, ["user", "rm", "mina", "--file", file]).exit_code == 0
    short = run(group, words, input="short\nshort\n")
    assert "8 characters" in str(short.exception)


def test_panel_tells_its_address() -> None:
    done = tms("panel", "--task", "4", "--url")
    assert done.stdout.endswith("/panel.html?task=4\n")


@pytest.mark.parametrize(("bind", "host"), [("0.0.0.0", "127.0.0.1"), ("::1", "[::1]")])
def test_panel_and_up_tell_an_address_that_a_browser_opens(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, bind: str, host: str
) -> None:
    from click.testing import CliRunner

    from tms_cli import mesh
    from tms_cli.main import tms as group

    site = tmp_path / "site.yaml"
    tls = "{certificate: cert.pem, key: key.pem}"
    site.write_text(f"name: yard\ndomain: 1\nbind: '{bind}'\nconsole: {{tls: {tls}}}\nservices: {{ur: {{}}}}\n")
    monkeypatch.setattr(mesh, "up", lambda *_: True)
    monkeypatch.setattr(mesh, "wait_ready", lambda *_: None)
    for words in (["panel", "--task", "4", "--url"], ["up"]):
        assert f"https://{host}:8080" in CliRunner().invoke(group, ["--site", str(site), *words]).output


HANGS = """
import ctypes, sys
from types import SimpleNamespace
from tms_cli import main, session
from tms_ros import node

def leave():
    print("leaving", file=sys.stderr, flush=True)
    ctypes.PyDLL(None).sleep(60)  # native code that keeps the interpreter, as DDS does

node.Ros = lambda name, **_: SimpleNamespace(stop=lambda: None, leave=leave)
session.call = lambda *_, **__: SimpleNamespace(runs=[])
main.LEAVE_LIMIT = 0.1
main.entry()
"""


@pytest.mark.parametrize(("words", "code"), [(["runs", "--json"], 0), (["events", "last"], 1)])
def test_a_command_that_hangs_as_it_leaves_has_said_all_and_ends_as_it_should(words: list[str], code: int) -> None:
    done = subprocess.run(
        [sys.executable, "-c", HANGS, *words], capture_output=True, text=True, timeout=50, check=False
    )
    assert done.returncode == code, done.stderr
    assert (done.stdout == "[]\n") is (code == 0)
    assert done.stderr.endswith("leaving\n")


def test_a_command_with_a_bug_leaves_the_graph_too() -> None:
    bug = HANGS.replace("    ctypes.PyDLL(None).sleep(60)", "    #").replace("runs=[]", "runs=len(None)")
    done = subprocess.run([sys.executable, "-c", bug, "runs"], capture_output=True, text=True, timeout=50, check=False)
    assert done.returncode == 1
    assert "TypeError: object of type 'NoneType'" in done.stderr and done.stderr.endswith("leaving\n")


def test_what_was_said_is_not_lost_in_a_pipe() -> None:
    assert "Usage: tms" in tms("--help").stdout


def test_a_site_without_processes_is_right_too(tmp_path: Path) -> None:
    site = tmp_path / "site.yaml"
    site.write_text("name: empty\ndomain: 1\nservices: {}\nmachines: {}\nstore: {kind: mongodb, uri: 'mongodb://x/'}\n")
    assert json.loads(tms("check", "--site", str(site), "--json").stdout)["processes"] == []
