from dataclasses import dataclass
from pathlib import Path
from typing import Optional, Tuple

from evaluation.options import RunOptions
from supervision.command_line import argument, option


@dataclass(frozen=True)
class Cockpit:
    """Show and control a running ROS graph in the browser, or play a recording.

    The functions of rviz, Gazebo's window and rqt in one page. Prints the URL of the page with its access
    token. The graph is that of ROS_MASTER_URI or, without a master there, the newest one on this machine.
    Ctrl-C closes the page; the graph continues.

    Exit code: 0 success, 1 failure or no result.json, 2 invalid input, 130 interrupted.
    """

    recordings: Tuple[Path, ...] = argument(
        "bags, folders of bags or run folders to play, from any position at any speed",
        default=(),
        type=Path,
        nargs="*",
        metavar="RECORDING",
    )
    web_port: str = option("127.0.0.1:0", "address of the page; port 0: a free one", metavar="[ADDRESS:]PORT")
    tool: Optional[str] = option(
        None, "open this tool at once (docs/how_to/watch_in_the_browser.md lists them)", metavar="NAME"
    )
    output: Path = option(
        Path("runs"),
        "folder in which the run folder of a replay is created",
        type=Path,
        metavar="FOLDER",
    )

    def run(self) -> int:
        return self._show_recording() if self.recordings else self._show_graph()

    def _show_recording(self) -> int:
        from cockpit.ros.node import check_tool
        from evaluation.recording_plan import recording_plan
        from evaluation.ros.run_modes import run_until_interrupted
        from home_service.ros.replaying import open_recording

        check_tool(self.tool)
        recording = open_recording(self.recordings, needs_scans=False)
        showing = RecordingView(web_port=self.web_port, output=self.output)
        plan = recording_plan(recording.paths, stays=True, tool=self.tool or "replay")
        return run_until_interrupted(showing, plan, "Ctrl-C closes it")

    def _show_graph(self) -> int:
        import os

        from cockpit.ros.node import serve
        from home_service.ros.graph_inspection import running_masters
        from supervision.ros.node_api import is_master_online

        if not is_master_online():
            masters = running_masters()
            if masters:
                os.environ["ROS_MASTER_URI"] = masters[0]
        return serve(self.web_port, self.tool)


@dataclass(frozen=True)
class RecordingView(RunOptions):
    """A recording that is shown until Ctrl-C."""

    is_interactive = True
