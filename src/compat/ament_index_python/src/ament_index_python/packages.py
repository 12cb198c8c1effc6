"""Where packages are: the one function that xacro 2 calls, for ``$(find PACKAGE)``."""

import rospkg


def get_package_share_directory(package_name: str) -> str:
    """The package's folder. Raises rospkg.ResourceNotFound."""
    return str(rospkg.RosPack().get_path(package_name))
