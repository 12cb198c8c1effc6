from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

PACKAGES = ["", ".control", ".costmap", ".nodes", ".planning", ".recovery"]

setup(
    **generate_distutils_setup(
        packages=["move_base_lite" + name for name in PACKAGES], package_dir={"": "src"}
    )
)
