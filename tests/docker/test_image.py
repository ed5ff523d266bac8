"""The image that a site gets, without the embedded store of trials, is small: some get it over a phone's network."""

import pytest
from docker_site import docker

pytestmark = [pytest.mark.docker, pytest.mark.timeout(400, func_only=True)]
LARGEST = 500e6  # bytes


def test_the_site_s_image_is_small(site_image: str) -> None:
    size = int(docker("image", "inspect", "--format", "{{.Size}}", site_image).stdout)
    assert size <= LARGEST, f"{size / 1e6:.0f} MB"


def test_every_module_of_ours_can_be_loaded_in_it(site_image: str) -> None:
    """What slim.sh removes and strips is needed by none."""
    code = (
        "import importlib, pkgutil; names = [one.name for one in pkgutil.walk_packages(['services'])]; "
        "print(len([importlib.import_module(name) for name in names if name.startswith('tms_')]))"
    )
    done = docker("run", "--rm", "--network=none", "--entrypoint=python3", site_image, "-c", code, limit=300)
    assert int(done.stdout.split()[-1]) > 700
