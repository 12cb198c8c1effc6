"""Console: log messages by node and level, and logger levels (rqt_console, rqt_logger_level)."""

from roscpp.srv import GetLoggers, SetLoggerLevel

from cockpit.errors import CockpitError
from cockpit.models.log import HEADS, LEVELS, LogFilter, level_named
from cockpit.models.tables import table
from cockpit.ros.background import BackgroundCall
from cockpit.ros.calls import call
from cockpit.ros.tool import ToolContext

NONE = "(none)"
LOGGERS, SET_LEVEL = "/get_loggers", "/set_logger_level"


class ConsoleTool:
    name, title, seconds = "console", "Console", 0.5

    def __init__(self, context: ToolContext):
        self._context = context
        self._asking, self._setting = BackgroundCall(), BackgroundCall()

    def build(self) -> None:
        gui, guarded = self._context.gui, self._context.guarded
        self._lowest = gui.add_dropdown("From level", tuple(LEVELS.values()), initial_value="Info")
        self._node = gui.add_text("Node", "", hint="part of a node's name")
        self._text = gui.add_text("Message", "", hint="part of a message")
        gui.add_button("Clear", color="gray").on_click(guarded(lambda _: self._context.log.clear()))
        with gui.add_folder("Logger levels", expand_by_default=False):
            self._logging_node = gui.add_dropdown("Of node", (NONE,))
            self._logger = gui.add_dropdown("Logger", (NONE,))
            self._level = gui.add_dropdown("Level", tuple(LEVELS.values()), initial_value="Info")
            gui.add_button("Set the level").on_click(guarded(self._set_level))
        self._lines = gui.add_html("")  # last, since it grows
        self._logging_node.on_update(guarded(self._ask_loggers))

    def update(self, now: float) -> None:
        wanted = LogFilter(level_named(self._lowest.value), self._node.value, self._text.value)
        content = table(HEADS, self._context.log.rows(wanted))
        if self._lines.content != content:
            self._lines.content = content
        services = self._context.graph.services()
        nodes = sorted(name[: -len(LOGGERS)] for name in services if name.endswith(LOGGERS))
        if self._logging_node.options != (NONE, *nodes):
            self._logging_node.options = (NONE, *nodes)
        for background in (self._asking, self._setting):
            for do in background.results():
                do()

    def pause(self) -> None:
        """Do nothing: the cockpit collects the messages."""

    close = pause

    def _ask_loggers(self, _event) -> None:
        node = self._logging_node.value
        self._logger.options = (NONE,)
        self._asking.restart(lambda: self._read_loggers(node))

    def _read_loggers(self, node: str):
        loggers = call(node + LOGGERS, GetLoggers).loggers if node != NONE else ()
        levels = {logger.name: logger.level.capitalize() for logger in loggers}

        def offer() -> None:
            self._logger.options = tuple(sorted(levels, key=lambda name: (name != "rosout", name))) or (NONE,)
            level = levels.get(self._logger.value, "")
            if level in LEVELS.values():
                self._level.value = level

        return offer

    def _set_level(self, _event) -> None:
        node, logger, level = self._logging_node.value, self._logger.value, self._level.value
        if NONE in (node, logger):
            raise CockpitError("choose a node and a logger first")

        def ask():
            call(node + SET_LEVEL, SetLoggerLevel, logger, level.lower())
            return lambda: self._context.notify(f"{node}: {logger} is at {level}")

        self._setting.start(ask)


TOOL = ConsoleTool
