from planar_ros.node.entry import call
from supervision.interruption import leave

leave(call("home_service_gym.cli:main"))
