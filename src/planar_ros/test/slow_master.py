"""A ROS master that runs a callback before it answers a subscription."""

import os
import sys
import threading
from contextlib import contextmanager
from xmlrpc.server import SimpleXMLRPCServer

REGISTRATIONS = ("registerSubscriber", "registerPublisher")


@contextmanager
def slow_master(topic, on_subscribe):
    """Yield the environment for nodes; ``on_subscribe`` is called when one subscribes to ``topic``."""

    class Master:
        def _dispatch(self, method, arguments):
            if method == "registerSubscriber" and arguments[1] == topic:
                on_subscribe()
            return [-1, "", 0] if method == "getParam" else [1, "", [] if method in REGISTRATIONS else 0]

    with SimpleXMLRPCServer(("127.0.0.1", 0), logRequests=False) as server:
        server.register_instance(Master())
        threading.Thread(target=server.serve_forever, daemon=True).start()
        ros = {"ROS_MASTER_URI": f"http://127.0.0.1:{server.server_address[1]}", "ROS_IP": "127.0.0.1"}
        yield {**os.environ, **ros, "PYTHONPATH": os.pathsep.join(sys.path)}
        server.shutdown()
