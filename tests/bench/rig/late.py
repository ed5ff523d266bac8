"""A node of ours that comes late, in a process of its own: Fast DDS keeps what it once knew of a discovery server.

python late.py COUNT    prints the milliseconds until it knows COUNT others
"""

from __future__ import annotations

import sys
import time

from tms_ros.node import Ros
from tms_runtime.priority import undisturbed

LIMIT = 60.0  # s
LOOK = 0.005  # s


def main(count: str) -> None:
    begun = time.perf_counter()  # everything is imported; the node is made now
    ros = Ros("late", creating=undisturbed())  # as all our programs make theirs
    while len(ros.node.get_node_names()) <= int(count):
        assert time.perf_counter() - begun < LIMIT, f"only {len(ros.node.get_node_names()) - 1} of {count} found"
        time.sleep(LOOK)
    print((time.perf_counter() - begun) * 1000, flush=True)
    ros.close()


if __name__ == "__main__":
    main(*sys.argv[1:])
