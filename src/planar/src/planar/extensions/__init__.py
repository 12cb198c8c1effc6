"""Extension points: user-defined classes that replace a planner, a model, a layer or another part.

An extension point is one file, its protocol: the class whose methods a plugin implements, the types of their
arguments and answers, and an ``ExtensionPoint`` with what the caller relies on. A plugin is found by its
dotted name or entry point (``loading``), its arguments are read-only views (``views``), its answers are
checked and its failures named (``point``). A ``Registry`` adds the shipped implementations, ``check`` the
checks of a contract from the command line.
"""

from planar.extensions.loading import PluginError, load_object
from planar.extensions.point import MAX_CALL_SECONDS, ExtensionPoint, Guard, InvalidAnswer, class_of
from planar.extensions.registry import Plugin, Registry, SelectedPlugins, registries_of

__all__ = [
    "MAX_CALL_SECONDS",
    "ExtensionPoint",
    "Guard",
    "InvalidAnswer",
    "Plugin",
    "PluginError",
    "Registry",
    "SelectedPlugins",
    "class_of",
    "load_object",
    "registries_of",
]
