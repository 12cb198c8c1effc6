from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(
    **generate_distutils_setup(
        packages=["turtlebot3_example", "turtlebot3_example.ros"], package_dir={"": "src"}
    )
)
