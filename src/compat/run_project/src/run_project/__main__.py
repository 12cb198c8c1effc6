from home_service.interruption import leave
from planar_ros.entry import call

leave(call("run_project.cli:main"))
