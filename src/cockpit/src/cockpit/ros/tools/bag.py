"""Bag: record topics to a file, and play, pause and stop a bag (rqt_bag, rosbag)."""

import os
from pathlib import Path
from typing import List, Optional

from std_srvs.srv import SetBool

from cockpit.child_program import ChildProgram
from cockpit.errors import CockpitError
from cockpit.models.bag_files import bags_below, new_bag
from cockpit.models.text import amount
from cockpit.ros.background import BackgroundCall
from cockpit.ros.calls import call
from cockpit.ros.tool import ToolContext
from planar_ros.bags.recording import Recording

NONE, PAUSE = "(none)", "/pause_playback"
ROSBAG = ("rosrun", "rosbag")


class BagTool:
    name, title, seconds = "bag", "Bag", 0.5

    def __init__(self, context: ToolContext):
        self._context = context
        self._folder = Path.cwd()
        self._recorder: Optional[ChildProgram] = None
        self._player: Optional[ChildProgram] = None
        self._file = Path()
        self._background = BackgroundCall()

    def build(self) -> None:
        gui, guarded = self._context.gui, self._context.guarded
        with gui.add_folder("Record"):
            self._name = gui.add_text("File", "recording.bag", hint=f"in {self._folder}")
            self._topics = gui.add_text("Topics", "", hint="names separated by spaces; empty for all")
            gui.add_button("Record").on_click(guarded(lambda _: self._record()))
            gui.add_button("Stop the recording", color="gray").on_click(
                guarded(lambda _: self._end_recorder())
            )
        with gui.add_folder("Play"):
            self._found = gui.add_dropdown("Found", (NONE,), hint=f"in {self._folder} and its runs")
            self._path = gui.add_text("or its path", "")
            self._rate = gui.add_number("Rate", 1.0, min=0.01, max=100.0, step=0.1)
            self._clock = gui.add_checkbox("Publish /clock", False, hint="for nodes with use_sim_time")
            gui.add_button("Play").on_click(guarded(lambda _: self._play()))
            gui.add_button("Pause", color="gray").on_click(guarded(lambda _: self._pause(True)))
            gui.add_button("Resume", color="gray").on_click(guarded(lambda _: self._pause(False)))
            gui.add_button("Stop", color="gray").on_click(guarded(lambda _: self._end_player()))
        self._status = gui.add_markdown("")

    def update(self, now: float) -> None:
        options = (NONE, *bags_below(self._folder))
        if self._found.options != options:
            self._found.options = options
        for do in self._background.results():
            do()
        self._status.content = "  \n".join(self._status_lines())

    def pause(self) -> None:
        """Recording and playing continue while no page is open."""

    def close(self) -> None:
        self._end_recorder()
        self._end_player()

    def _status_lines(self) -> List[str]:
        lines = []
        if self._recorder is not None:
            part = self._file.with_suffix(".bag.active")
            size = next((path.stat().st_size for path in (part, self._file) if path.exists()), 0)
            state = "recording" if self._recorder.is_running else "recorded"
            lines.append(f"{state} {self._file.name}: {amount(size)}")
        if self._player is not None:
            lines.append("playing" if self._player.is_running else "finished playing")
            lines += [f"the player failed: {line}" for line in self._player.complaints()]
        return lines

    def _record(self) -> None:
        if self._recorder is not None and self._recorder.is_running:
            raise CockpitError(f"{self._file.name} is being recorded; stop that first")
        path = new_bag(self._folder, self._name.value)
        if not os.access(self._folder, os.W_OK):
            raise CockpitError(f"{self._folder} is not writable")
        topics = self._topics.value.split()
        bad = [topic for topic in topics if not topic.startswith("/")]
        if bad:
            raise CockpitError(f"'{bad[0]}' is not a topic name; it must begin with /")
        self._file = path
        self._recorder = ChildProgram([*ROSBAG, "record", "-O", str(path), *(topics or ["--all"])])

    def _end_recorder(self) -> None:
        if self._recorder is not None:
            self._recorder.end()

    def _play(self) -> None:
        if self._player is not None and self._player.is_running:
            raise CockpitError("a bag is being played; stop that first")
        chosen = self._path.value.strip() or self._found.value
        if chosen == NONE:
            raise CockpitError("choose a bag first")
        path, rate, clock = self._folder / chosen, self._rate.value, self._clock.value

        def check():
            bags = Recording([path]).paths  # checks that the bag can be read before anything is published
            words = ["play", "--rate", f"{rate:g}", *(["--clock"] if clock else []), *map(str, bags)]

            def start() -> None:
                self._player = ChildProgram([*ROSBAG, *words])

            return start

        self._background.start(check)

    def _pause(self, is_paused: bool) -> None:
        """Pause or resume every bag player of the graph."""
        found = [name for name in self._context.graph.services() if name.endswith(PAUSE)]
        if not found:
            raise CockpitError("no bag is being played")

        def ask():
            for name in found:
                call(name, SetBool, is_paused)
            return lambda: None

        self._background.start(ask)

    def _end_player(self) -> None:
        if self._player is not None:
            self._player.end()


TOOL = BagTool
