"""The Chromium of this PC, without a screen, and calls of the console: for tests, benchmarks and pictures."""

from __future__ import annotations

import json
import urllib.error
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from playwright.sync_api import Browser, Page, sync_playwright

from conftest import tool

LIMIT = 60.0  # s for whatever must happen at all
FLAGS = ["--no-sandbox", "--disable-gpu", "--disable-background-networking"]


class Refused(Exception):
    """Why the API refuses a call."""


@contextmanager
def chromium() -> Iterator[Browser]:
    """One that is closed in the end."""
    program = tool("chromium", "chromium-browser")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=program, args=FLAGS)
        yield browser
        browser.close()


def narrated(page: Page) -> Page:
    """The page, which prints what it asks for and what its scripts tell: pytest shows that of a failed test."""
    page.on("framenavigated", lambda frame: print(f"page: is at {frame.url}"))
    page.on("request", lambda one: print(f"page: {one.method} {one.url}"))
    page.on("response", lambda one: print(f"page: {one.status} {one.url}"))
    page.on("requestfailed", lambda one: print(f"page: {one.failure} {one.url}"))
    page.on("console", lambda line: print(f"page: {line.type}: {line.text}"))
    page.on("pageerror", lambda error: print(f"page: script failed: {error}"))
    return page


def ask(address: str, path: str, body: Any = None) -> Any:
    """An answer of the API; an error of a run that has just ended is none."""
    data = None if body is None else json.dumps(body).encode()
    request = urllib.request.Request(address + path, data, {"Content-Type": "application/json"})
    try:
        with urllib.request.urlopen(request, timeout=LIMIT) as answer:
            return json.load(answer)
    except urllib.error.HTTPError as error:
        with error:
            found = json.load(error)
        if found.get("code") != "NO_RUN":  # a program that is no console has no code
            raise Refused(found.get("text", {}).get("en", found)) from error
        return None
