"""Imported by the process that tests fork `tms` from, see programs.py: the libraries and the verbs of `tms`."""

import importlib
import pkgutil

from tms_cli import commands
from tms_host import prefork

prefork.load(f"tms:{name}" for name in prefork.LIBRARIES_OF)
for verb in pkgutil.iter_modules(commands.__path__):
    importlib.import_module(f"tms_cli.commands.{verb.name}")
