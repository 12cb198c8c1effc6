"""The Home tab: the editor of build_home.sh in the page, in place of the view."""

import os
import sys
from html import escape
from pathlib import Path
from typing import Any, Callable, Optional
from urllib.parse import urlsplit

from cockpit.errors import CockpitError
from cockpit.models.tables import paragraph
from cockpit.page.window_column import WIDTH
from cockpit.page_program import PageProgram
from cockpit.ros.graph import GraphClient
from cockpit.ros.world.world import WORLD_PARAMETERS

PLAN = "plan.yaml"
NEW_HOME = Path("homes/home")
HINT = (
    "Draw a home, or change the one that is shown: walls, doors, furniture, places and zones. The editor "
    "saves every change; its button Drive starts a robot in the new home."
)
# Beside the column of the panels; above the canvas of the view.
FRAME = (
    '<a href="{url}" target="_blank" rel="noopener" style="margin:0 12px">open it in another tab</a>'
    '<iframe title="Home editor" src="{url}" style="position:fixed;left:0;top:0;z-index:5;border:0;'
    f'width:calc(100vw - {WIDTH}px);height:100vh;background:white"></iframe>'
)


class HomeTab:
    """Starts the editor as a child process, and shows its page.

    Args:
        graph: Client of the ROS graph.
        origin: Origin of the cockpit's page, which may show that of the editor.
    """

    def __init__(self, graph: GraphClient, origin: str):
        self._graph, self._origin = graph, origin
        self._editor: Optional[PageProgram] = None
        self._wanted: Optional[str] = None
        self._shown: Optional[str] = None

    def build(self, gui: Any, tab: Any, guarded: Callable[[Callable], Callable]) -> None:
        """Create the controls.

        Args:
            gui: The gui of viser.
            tab: The tab's context.
            guarded: Wraps callbacks of controls so that exceptions are reported on the page.
        """
        with tab:
            gui.add_html(paragraph(HINT))
            self._folder = gui.add_text("Folder", str(NEW_HOME), hint="made if it is missing")
            self._button = gui.add_button("Edit the home")
            self._frame = gui.add_html("")
        self._proposed = self._folder.value
        self._button.on_click(guarded(lambda _: self._press()))

    def refresh(self) -> None:
        """Propose the home whose world is simulated. Raises CockpitError."""
        home = self._simulated_home()
        if home is not None and self._folder.value == self._proposed:
            self._folder.value = self._proposed = str(home)

    def update(self) -> None:
        """Start, show or end the editor, in the thread of the cockpit, as programs end with their thread.

        Raises:
            CockpitError: It does not start; the text has the reason.
        """
        wanted, self._wanted = self._wanted, None
        if wanted is not None:
            self.close()
            if wanted:
                self._editor = self._start(wanted)
        try:
            url = None if self._editor is None else self._editor.printed_url()
            if self._editor is not None and url is not None and not self._editor.is_running:
                raise CockpitError("the editor has ended; what was drawn is saved")
        except CockpitError:
            self.close()
            raise
        finally:
            self._show(None if self._editor is None else url)

    def close(self) -> None:
        """End the editor; what is drawn is saved."""
        if self._editor is not None:
            self._editor.close()
            self._editor = None

    def _press(self) -> None:
        self._wanted = "" if self._editor is not None else self._folder.value.strip() or str(NEW_HOME)

    def _start(self, folder: str) -> PageProgram:
        address = urlsplit(self._origin).hostname
        words = ["--output", folder, "--web-port", f"{address}:0", "--frame-of", self._origin]
        return PageProgram([sys.executable, "-m", "home_builder", "build_home", *words], "edit the home")

    def _show(self, url: Optional[str]) -> None:
        if url == self._shown:
            return
        self._shown = url
        self._frame.content = "" if url is None else FRAME.format(url=escape(url))
        self._button.label = "Edit the home" if url is None else "Close the editor"

    def _simulated_home(self) -> Optional[Path]:
        names = self._graph.parameter_names()
        for name in WORLD_PARAMETERS:
            world = self._graph.parameter(name) if name in names else None
            if isinstance(world, str) and (Path(world).parent / PLAN).is_file():
                return Path(os.path.relpath(Path(world).parent))
        return None
