"""A headless browser, driven by the Chrome DevTools Protocol."""

import base64
import itertools
import json
import os
import shutil
import subprocess
import tempfile
import time
import urllib.request
from contextlib import suppress
from pathlib import Path

import psutil
from waiting import wait_until
from websockets.sync.client import connect

NAMES = ("chromium", "chromium-browser", "google-chrome")
# A page sends the last change of a field within this time [s].
TYPING_SECONDS = 0.6
STILL_SECONDS = 0.1
# Key repeat of a keyboard with the usual settings of desktops.
REPEAT_DELAY_SECONDS, REPEAT_SECONDS = 0.5, 0.033
START_SECONDS, ANSWER_SECONDS = 60.0, 60.0
# Error code of the protocol: the execution context is gone or does not exist yet.
NO_CONTEXT = -32000
# Time between two reads of a page: each triggers a new layout [s].
READ_SECONDS = 0.2
# Software rendering, and no background network traffic.
OPTIONS = (
    "--headless=new",
    "--no-sandbox",
    "--no-first-run",
    "--hide-scrollbars",
    "--mute-audio",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-default-apps",
    "--disable-dev-shm-usage",
    "--disable-extensions",
    "--disable-sync",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--remote-debugging-port=0",
)
# As root the browser would raise its own priority above that of the nodes.
NO_PRIORITY = ("setpriv", "--bounding-set", "-sys_nice") if os.geteuid() == 0 else ()


def executable():
    """Return the path of a browser, or None."""
    return next(filter(None, map(shutil.which, NAMES)), None)


class Browser:
    """Starts a browser; ``open`` opens pages."""

    def __init__(self):
        assert executable() is not None, "no browser: ./scripts/setup.sh --dev installs one"
        self._folder = tempfile.mkdtemp()
        port_file = Path(self._folder) / "DevToolsActivePort"
        self._process = subprocess.Popen(
            [*NO_PRIORITY, executable(), *OPTIONS, f"--user-data-dir={self._folder}", "about:blank"],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            env={**os.environ, "HOME": self._folder},
        )
        wait_until(
            "the browser", lambda: port_file.exists() and port_file.read_text().count("\n"), START_SECONDS
        )
        self._port = int(port_file.read_text().split()[0])

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def open(self, url, width=1280, height=800):
        """Open ``url`` in a new tab."""
        request = urllib.request.Request(f"http://127.0.0.1:{self._port}/json/new?about:blank", method="PUT")
        with urllib.request.urlopen(request, timeout=ANSWER_SECONDS) as answer:
            address = json.load(answer)["webSocketDebuggerUrl"]
        return Tab(address, url, width, height)

    def niceness(self):
        """Return the niceness of each process of the browser."""
        return [each.nice() for each in psutil.Process(self._process.pid).children(recursive=True)]

    def close(self):
        self._process.terminate()
        try:
            self._process.wait(5.0)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        shutil.rmtree(self._folder, ignore_errors=True)


def _find(label, kind=None):
    """Return an expression for the field, or the input of another kind, with a label."""
    return f"({FIND_INPUT})({json.dumps(label)}, {json.dumps(kind or FIELD)})"


class PageNavigatedError(AssertionError):
    """The page navigated to another one during a request."""


class Tab:
    """A tab. ``errors``: errors in the console of its page; ``requests``: URLs that it has requested."""

    def __init__(self, address, url, width, height):
        self._socket = connect(address, max_size=None, open_timeout=ANSWER_SECONDS)
        self._numbers = itertools.count(1)
        self.errors, self.requests = [], []
        self._counts_time = False
        for domain in ("Runtime", "Log", "Network", "Page"):
            self._ask(f"{domain}.enable")
        size = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
        self._ask("Emulation.setDeviceMetricsOverride", **size)
        self._ask("Page.navigate", url=url)

    def evaluate(self, script):
        """Evaluate an expression in the page."""
        answer = self._ask("Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True)
        assert "exceptionDetails" not in answer, answer["exceptionDetails"]
        return answer["result"].get("value")

    def text(self):
        """Return the visible text of the page."""
        return self.evaluate("document.body ? document.body.innerText : ''") or ""

    def wait_for(self, *texts, seconds=30.0):
        """Wait until all texts are on the page, or on the one to which it redirects."""

        def are_there():
            try:
                seen = self.text()
            except PageNavigatedError:
                return False
            return all(text in seen for text in texts)

        wait_until(f"{texts} on the page", are_there, seconds, READ_SECONDS)

    def click(self, text, seconds=20.0):
        """Click the innermost element with this text or label.

        The page clicks a button itself: the mouse could hit another one if the page moves meanwhile.
        """
        element = f"({FIND_TEXT})({json.dumps(text)})"
        wait_until(
            f"'{text}' to click", lambda: self._is_stable(element) and self._has_clicked(element), seconds
        )

    def click_at(self, x, y):
        self.drag((x, y), (x, y))

    def drag(self, start, end, steps=8, modifiers=0):
        """The left button pressed at ``start``, moved, and released at ``end``, pixels."""
        held = {"button": "left", "modifiers": modifiers}
        self._mouse("mouseMoved", *start)
        self._mouse("mousePressed", *start, clickCount=1, buttons=1, **held)
        for step in range(1, steps + 1) if start != end else ():
            x, y = (a + (b - a) * step / steps for a, b in zip(start, end))
            self._mouse("mouseMoved", x, y, buttons=1, **held)
            time.sleep(0.02)
        self._mouse("mouseReleased", *end, clickCount=1, **held)

    def move_mouse(self, x, y):
        self._mouse("mouseMoved", x, y)

    def press_key(self, key, code=None, modifiers=0):
        """Press and release a key: a character, or another one with its code; modifiers: 2 Ctrl, 8 Shift."""
        # The codes of other characters, as characters, are those of keys such as Delete.
        number = code or (ord(key.upper()) if key.isalnum() else 0)
        text = {"text": "\r" if key == "Enter" else key} if len(key) == 1 or key == "Enter" else {}
        keys = {"key": key, "windowsVirtualKeyCode": number, "modifiers": modifiers}
        self._ask("Input.dispatchKeyEvent", type="keyDown", **keys, **({} if modifiers & ~8 else text))
        self._ask("Input.dispatchKeyEvent", type="keyUp", **keys)

    def choose_file(self, selector, path):
        """Choose a file in the input with this selector."""
        root = self._ask("DOM.getDocument")["root"]["nodeId"]
        node = self._ask("DOM.querySelector", nodeId=root, selector=selector)["nodeId"]
        self._ask("DOM.setFileInputFiles", files=[str(path)], nodeId=node)

    def hold(self, text, seconds):
        """Hold the button with this text for some seconds."""
        place = self._place_of(f"({FIND_TEXT})({json.dumps(text)})")
        assert place is not None, text
        self._mouse("mouseMoved", *place)
        self._mouse("mousePressed", *place, button="left", clickCount=1, buttons=1)
        time.sleep(seconds)
        self._mouse("mouseReleased", *place, button="left", clickCount=1)

    def press(self, text):
        """Press the button with this text without releasing it."""
        place = self._place_of(f"({FIND_TEXT})({json.dumps(text)})")
        assert place is not None, text
        self._mouse("mouseMoved", *place)
        self._mouse("mousePressed", *place, button="left", clickCount=1, buttons=1)

    def hold_key(self, key, what, is_met):
        """Press a letter key with key repeat until ``is_met``; the key stays down."""
        self._key("keyDown", key)
        deadline = time.monotonic() + REPEAT_DELAY_SECONDS

        def is_met_or_repeats():
            time.sleep(REPEAT_SECONDS)
            if time.monotonic() > deadline:
                self._key("keyDown", key, autoRepeat=True)
            return is_met()

        wait_until(what, is_met_or_repeats)

    def release_key(self, key):
        self._key("keyUp", key)

    def choose(self, label, option):
        """Choose an option of the list with this label."""
        wait_until(f"a list {label}", lambda: self._place_of_input(label) is not None)
        for _ in range(20):
            place = self._place_of_input(label)
            if place is not None and not self._offered(label):
                self.click_at(*place)
            with suppress(AssertionError):
                wait_until(f"{option} in {label}", lambda: option in self._offered(label), 1.0)
                time.sleep(0.2)  # it moves while it opens
                place = self._place_of_option(label, option)
                if place is not None:
                    self.click_at(*place)
                wait_until(f"{option} chosen", lambda: self.value_of(label) == option, 1.0)
                return
        offered = f"which offers {self._offered(label)}: {self.text()}"
        raise AssertionError(f"'{option}' could not be chosen of '{label}', {offered}")

    def tick(self, label):
        """Toggle the checkbox with this label.

        The page clicks it itself: the mouse could hit another one if the page moves meanwhile.
        """
        wait_until(f"a box {label} to click", lambda: self._is_stable(_find(label, BOX)))
        before = self.is_ticked(label)
        self.evaluate(f"{_find(label, BOX)}.click()")
        wait_until(f"'{label}' to be toggled", lambda: self.is_ticked(label) == (not before))

    def value_of(self, label):
        """Return the value of the field with this label."""
        return self.evaluate(f"({_find(label)} || {{}}).value")

    def is_ticked(self, label):
        """Return whether the checkbox with this label is ticked."""
        return self.evaluate(f"({_find(label, BOX)} || {{}}).checked")

    def focus(self, label):
        """Let keys be written into the field with this label."""
        wait_until(f"a field {label}", lambda: self._place_of_input(label) is not None)
        self.evaluate(f"{_find(label)}.focus()")

    def fill_in(self, label, text):
        """Replace the value of the field with this label."""
        self.focus(label)
        self.evaluate("document.activeElement.select && document.activeElement.select()")
        self._ask("Input.insertText", text=text)
        self.evaluate("document.activeElement.blur()")
        # A timer of the page: a busy page delays its messages and this timer alike.
        self.evaluate(f"new Promise((done) => setTimeout(done, {TYPING_SECONDS * 1000}))")

    def thread_seconds(self):
        """Return the CPU time that the main thread of the page has spent in tasks [s]."""
        if not self._counts_time:
            self._ask("Performance.enable", timeDomain="threadTicks")
            self._counts_time = True
        metrics = self._ask("Performance.getMetrics")["metrics"]
        return next(each["value"] for each in metrics if each["name"] == "TaskDuration")

    def screenshot(self, path):
        picture = self._ask("Page.captureScreenshot", format="png")["data"]
        Path(path).write_bytes(base64.b64decode(picture))

    def close(self):
        with self._socket:
            self._ask("Page.close")

    def _place_of(self, element):
        return self.evaluate(f"({UNCOVERED})({element}, {MIDDLE})")

    def _is_stable(self, element):
        """Whether the element is visible, not covered, and not moving."""
        place = self._place_of(element)
        time.sleep(STILL_SECONDS)
        return place is not None and place == self._place_of(element)

    def _has_clicked(self, element):
        """Click an element unless it is covered; return whether it was clicked."""
        if self.evaluate(f"({CLICK_BUTTON})(({UNCOVERED})({element}, {MIDDLE}) && {element})"):
            return True
        place = self._place_of(element)
        if place is not None:
            self.click_at(*place)
        return place is not None

    def _place_of_input(self, label):
        return self.evaluate(f"({MIDDLE})({_find(label)})")

    def _offered(self, label):
        """The options of this list if it is open; a misplaced click may have opened another one."""
        return self.evaluate(f"({OPTIONS_OF})({json.dumps(label)}).map((one) => one.innerText.trim())")

    def _place_of_option(self, label, option):
        of_that_name = f"(one) => one.innerText.trim() === {json.dumps(option)}"
        return self.evaluate(f"({MIDDLE})(({OPTIONS_OF})({json.dumps(label)}).find({of_that_name}))")

    def _mouse(self, kind, x, y, **more):
        self._ask("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)

    def _key(self, kind, key, **more):
        code = ord(key.upper())
        self._ask(
            "Input.dispatchKeyEvent",
            type=kind,
            key=key,
            code=f"Key{key.upper()}",
            text="" if kind == "keyUp" else key,
            windowsVirtualKeyCode=code,
            nativeVirtualKeyCode=code,
            **more,
        )

    def _ask(self, method, **parameters):
        number = next(self._numbers)
        self._socket.send(json.dumps({"id": number, "method": method, "params": parameters}))
        deadline = time.monotonic() + ANSWER_SECONDS
        while True:
            response = json.loads(self._socket.recv(max(deadline - time.monotonic(), 0.01)))
            if response.get("id") == number:
                if response.get("error", {}).get("code") == NO_CONTEXT:
                    raise PageNavigatedError(f"{method}: {response['error']}")
                assert "error" not in response, f"{method}: {response['error']}"
                return response["result"]
            self._record(response)

    def _record(self, event):
        params, kind = event.get("params", {}), event.get("method")
        if kind == "Runtime.exceptionThrown":
            self.errors.append(str(params["exceptionDetails"]))
        elif kind == "Runtime.consoleAPICalled" and params["type"] in ("error", "assert"):
            self.errors.append(" ".join(str(each.get("value")) for each in params["args"]))
        elif kind == "Log.entryAdded" and params["entry"]["level"] == "error":
            self.errors.append(params["entry"]["text"])
        elif kind == "Network.requestWillBeSent":
            self.requests.append(params["request"]["url"])
        elif kind == "Network.webSocketCreated":
            self.requests.append(params["url"])


# The innermost visible element with a text, the last one of several.
FIND_TEXT = """(text) => [...document.querySelectorAll('button, label, span, p, div, a')].filter(
    (one) => one.innerText && one.innerText.trim() === text && one.getClientRects().length).pop() || null"""
BOX, FIELD = "input[type=checkbox]", "input:not([type=hidden], [type=checkbox]), textarea"
# The checkbox or field of the row that begins with a label; the row of a checkbox has no other text. While
# the page changes its layout, the label may be missing; the title of a window must not be taken for it.
FIND_INPUT = """(label, kind) => {
    for (const one of document.querySelectorAll('label, p, div, span')) {
        const isInner = !one.querySelector(':scope > :not(wbr)');
        if (!isInner || one.textContent.trim() !== label || !one.getClientRects().length) continue;
        for (let row = one.parentElement, n = 0; row && n < 5; row = row.parentElement, n++) {
            const found = row.querySelector(kind);
            if (found && found.type === 'checkbox' && row.textContent.trim() !== label) break;
            if (found) return found;
        }
    }
    return null;
}"""
OPTIONS_OF = f"""(label) => {{
    const input = ({FIND_INPUT})(label, {FIELD!r});
    const list = input && document.getElementById(input.getAttribute('aria-controls'));
    const options = list ? [...list.querySelectorAll('[role=option]')] : [];
    return options.filter((one) => one.getClientRects().length);
}}"""
MIDDLE = """(one) => {
    if (!one) return null;
    one.scrollIntoView({block: 'nearest'});
    const box = one.getBoundingClientRect();
    return [box.x + box.width / 2, box.y + box.height / 2];
}"""
# Whether an element is part of a button, which is clicked then.
CLICK_BUTTON = """(one) => {
    const button = one && one.closest('button');
    if (button) button.click();
    return Boolean(button);
}"""
# The centre of an element, unless another element covers it and would receive the click.
UNCOVERED = """(one, middle) => {
    const place = middle(one);
    const top = place && document.elementFromPoint(...place);
    return top && (one.contains(top) || top.contains(one)) ? place : null;
}"""
