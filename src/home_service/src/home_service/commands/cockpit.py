from dataclasses import dataclass
from typing import Optional

from supervision.command_line import option


@dataclass(frozen=True)
class Cockpit:
    """Shows a running ROS graph in the browser, and drives it."""

    web_port: str = option(
        "127.0.0.1:0", "where the page is served; 0: a free port", metavar="[ADDRESS:]PORT"
    )
    tool: Optional[str] = option(None, "open this tool at once", metavar="NAME")

    def run(self) -> int:
        import os

        from cockpit.ros.node import serve
        from home_service.ros.examination import running_masters
        from supervision.ros.node_api import is_master_online

        if not is_master_online():
            masters = running_masters()
            if masters:
                os.environ["ROS_MASTER_URI"] = masters[0]
        return serve(self.web_port, self.tool)
