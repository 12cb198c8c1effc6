from planar_ros.node.entry import call
from supervision.interruption import leave

if __name__ == "__main__":
    leave(call("run_project.cli:main"))
