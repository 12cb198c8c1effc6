"""Package lookup for xacro 2, which calls this function for ``$(find PACKAGE)``."""

import rospkg


def get_package_share_directory(package_name: str) -> str:
    """Folder of a package. Raises rospkg.ResourceNotFound."""
    return str(rospkg.RosPack().get_path(package_name))
