"""The fixtures of the container harness."""

from docker_site import image, yard

__all__ = ["image", "yard"]
