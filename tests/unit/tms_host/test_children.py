"""Whether supervisord has other children, read from /proc."""

import os
import subprocess
import sys

from tms_host.node import Children


def test_a_new_child_and_its_end_are_changes() -> None:
    children = Children(os.getpid())
    children.changed()
    assert not children.changed()
    with subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE) as child:
        assert children.changed()
        assert not children.changed()
        child.communicate()
    assert children.changed()
    assert not children.changed()


def test_a_kernel_that_does_not_tell_has_supervisord_asked_each_time() -> None:
    nobody = Children(2**22 + 1)  # above the largest pid
    assert nobody.changed()
    assert nobody.changed()
