from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(
    **generate_distutils_setup(packages=["turtlebot3_fake", "turtlebot3_fake.ros"], package_dir={"": "src"})
)
