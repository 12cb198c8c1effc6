from home_service.interruption import leave
from planar_ros.entry import call

leave(call("home_service.cli:main"))
