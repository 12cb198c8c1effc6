from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(
    **generate_distutils_setup(
        packages=["multirobot_map_merge", "multirobot_map_merge.ros"], package_dir={"": "src"}
    )
)
