from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(
    **generate_distutils_setup(
        packages=[
            "sim_bridge",
            "sim_bridge.description",
            "sim_bridge.nodes",
            "sim_bridge.nodes.gazebo",
            "sim_bridge.sdf",
            "sim_bridge.sensors",
        ],
        package_dir={"": "src"},
        package_data={"sim_bridge": ["urdf/*.urdf"]},
    )
)
