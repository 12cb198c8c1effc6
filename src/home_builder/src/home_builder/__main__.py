from planar_ros.node.entry import call
from supervision.interruption import leave

leave(call("home_builder.commands:main"))
