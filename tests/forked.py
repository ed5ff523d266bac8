"""What a fork of the process that has loaded our libraries becomes, see programs.py. It imports only what is quick."""

import os
import sys
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[1]


def be_tms(words: tuple[str, ...], env: dict[str, str], out: Path, err: Path) -> None:
    """Be `tms` with these words."""
    _write_to(out, err)
    os.environ.clear()
    os.environ.update(env)
    os.chdir(PROJECT)
    sys.argv = ["tms", *words]
    from tms_cli.main import main

    main()


def be_process(words: tuple[str, ...], env: dict[str, str], out: Path, err: Path) -> None:
    """Be the process of a mesh that is named so, as supervisord starts it."""
    _write_to(out, err)
    from tms_host.prefork import MODULE, exec_entry

    exec_entry([sys.executable, "-m", MODULE, *words], env, os.getppid())


def be_patient_console(words: tuple[str, ...], env: dict[str, str], out: Path, err: Path) -> None:
    """Be a console that closes nothing for the time that it hangs."""
    from tms_ur import connections, server

    for module in (connections, server):
        module.HEADERS = module.SILENCE = 600.0  # type: ignore[attr-defined]
    be_process(words, env, out, err)


def _write_to(out: Path, err: Path) -> None:
    for number, path in ((1, out), (2, err)):
        file = os.open(path, os.O_WRONLY | os.O_APPEND)
        os.dup2(file, number)
        os.close(file)
