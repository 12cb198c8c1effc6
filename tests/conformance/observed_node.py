"""Base of the observers: starts a node and reports what people and programs see of it."""

import json
import os
import subprocess
import sys
import time
from pathlib import Path
from typing import Any, Callable, Dict, List, Optional

import rosgraph
import rospy

PATIENCE, POLL = 25.0, 0.05


class ObservedNode:
    """The node in question.

    Attributes:
        given: Input of the observer.
        folder: Folder for files.
    """

    def __init__(self, name: str):
        self.given: Dict[str, Any] = json.loads(sys.stdin.read())
        self.name, self.folder = name, Path(os.environ["FOLDER"])
        rospy.init_node("observer", anonymous=False, disable_signals=True)
        for key, value in self.given.get("parameters", {}).items():
            rospy.set_param(f"/{name}/{key}", value)

    def start(self, *arguments: str) -> None:
        """Start the node."""
        command = [*self.given["command"], *arguments, f"__name:={self.name}"]
        with (self.folder / "log").open("wb") as log:
            self.process = subprocess.Popen(command, stdout=log, stderr=subprocess.STDOUT, cwd=self.folder)

    @property
    def exit_code(self) -> Optional[int]:
        """Exit code; None while it runs."""
        return self.process.poll()

    @property
    def log(self) -> str:
        """What it has printed."""
        return (self.folder / "log").read_text(encoding="utf-8", errors="replace")

    def wait_until(self, condition: Callable[[], Any], seconds: float = PATIENCE) -> bool:
        """Wait for a condition, or the end of the node; return whether the condition holds."""
        deadline = time.monotonic() + seconds
        while time.monotonic() < deadline and self.exit_code is None:
            if condition():
                return True
            time.sleep(POLL)
        return bool(condition())

    def topics(self, published: bool = True) -> Dict[str, str]:
        """Return topics, with their types, that the node publishes or subscribes to."""
        publishers, subscribers, _ = rosgraph.Master("/observer").getSystemState()
        types = dict(rosgraph.Master("/observer").getTopicTypes())
        chosen = publishers if published else subscribers
        return {topic: types.get(topic, "") for topic, nodes in chosen if f"/{self.name}" in nodes}

    def services(self) -> List[str]:
        """Return the services that the node offers."""
        services = rosgraph.Master("/observer").getSystemState()[2]
        return sorted(service for service, nodes in services if f"/{self.name}" in nodes)

    def end(self, seconds: float = PATIENCE) -> None:
        """Interrupt the node and wait for its end."""
        if self.exit_code is None:
            self.process.send_signal(2)
            try:
                self.process.wait(seconds)
            except subprocess.TimeoutExpired:
                self.process.kill()
                self.process.wait()


def report(observed: Dict[str, Any]) -> None:
    """Print what was observed, as the last line, and end this process with all its threads."""
    print(json.dumps(observed, sort_keys=True), flush=True)
    os._exit(0)
