"""viser's server behind the guard: the page's look, its lights, who is there."""

import contextlib
import io
import threading
from typing import Callable, List

import numpy as np
import viser

from cockpit.access import AccessPolicy
from cockpit.frames import wxyz_of
from cockpit.page.connection_guard import ConnectionGuard, listen
from cockpit.page.scene_renderer import LAID_DOWN
from cockpit.page.window_column import WindowColumn

NAME = "Cockpit"
BRAND = (38, 110, 160)
FIELD_OF_VIEW = 0.8
FLOOR_COLOUR = (236, 238, 240)
CAMERA, LOOK_AT = np.array((-5.5, -12.5, 14.5)), np.array((1.2, -0.6, 0.0))


class Page:
    """Serves the page.

    Args:
        address: Address to bind.
        port: Port; 0 selects a free one.

    Attributes:
        gui: The gui of viser, shared by all clients.
        scene: The scene of viser, shared by all clients.
        windows: The column of the main panel and the windows.
        origin: Origin of the page.
        url: Address of the page with the token.

    Raises:
        PortError: The page cannot be served at the address.
    """

    def __init__(self, address: str, port: int):
        listening = listen(address, port)
        port = listening.getsockname()[1]
        shown = "127.0.0.1" if address in ("0.0.0.0", "::") else address
        access = AccessPolicy(port, (shown,))
        self.origin = f"http://{f'[{shown}]' if ':' in shown else shown}:{port}"
        self.url = f"{self.origin}/?token={access.token}"
        self._on_leave: List[Callable[[int], None]] = []
        self._is_watched = threading.Event()
        # viser prints a URL without the token.
        guard = ConnectionGuard(listening, access)
        with guard.guarding(), contextlib.redirect_stdout(io.StringIO()):
            self._server = viser.ViserServer(address, port, label=NAME, verbose=False)
        self.gui, self.scene = self._server.gui, self._server.scene
        self.windows = WindowColumn(self.gui)
        guard.set_controls(self.gui)
        self._server.on_client_connect(self._on_connect)
        self._server.on_client_disconnect(self._on_disconnect)
        self._set_up_scene()

    @property
    def is_watched(self) -> bool:
        """Whether the page is open in any browser."""
        return self._is_watched.is_set()

    def wait_for_client(self, seconds: float) -> bool:
        """Wait until the page is open in a browser.

        Args:
            seconds: Longest time to wait [s].

        Returns:
            Whether the page is open.
        """
        return self._is_watched.wait(seconds)

    def clients(self) -> List[viser.ClientHandle]:
        return list(self._server.get_clients().values())

    def on_leave(self, do: Callable[[int], None]) -> None:
        """Register a callback for the id of each client whose page was closed or lost."""
        self._on_leave.append(do)

    def notify(self, text: str, is_bad: bool = False) -> None:
        """Show a notification on every open page, which closes automatically.

        Args:
            text: The notification.
            is_bad: Whether it reports an error.
        """
        for client in self.clients():
            client.add_notification(
                "Something went wrong" if is_bad else NAME,
                text[:500],
                color="red" if is_bad else None,
                auto_close_seconds=10.0 if is_bad else 5.0,
            )

    def atomic(self):
        """Group changes into one update of the pages."""
        return self._server.atomic()

    def frame_view(self, low_xy: np.ndarray, high_xy: np.ndarray) -> None:
        """Set the initial camera of new clients so that it shows an area.

        Args:
            low_xy: Corner (2,) with the smallest coordinates [m].
            high_xy: Corner (2,) with the largest coordinates [m].
        """
        middle = np.append(0.5 * (low_xy + high_xy), 0.0)
        away = 0.5 * float(np.linalg.norm(high_xy - low_xy)) / np.tan(0.5 * FIELD_OF_VIEW)
        direction = (CAMERA - LOOK_AT) / np.linalg.norm(CAMERA - LOOK_AT)
        self._server.initial_camera.position = middle + away * direction
        self._server.initial_camera.look_at = middle

    def close(self) -> None:
        with contextlib.redirect_stdout(io.StringIO()):
            self._server.stop()

    def _on_connect(self, _client: viser.ClientHandle) -> None:
        self._is_watched.set()

    def _on_disconnect(self, client: viser.ClientHandle) -> None:
        if not self._server.get_clients():
            self._is_watched.clear()
        for do in self._on_leave:
            do(client.client_id)

    def _set_up_scene(self) -> None:
        self.gui.configure_theme(
            show_logo=False, show_share_button=False, brand_color=BRAND, control_width="medium"
        )
        self._server.initial_camera.position = CAMERA
        self._server.initial_camera.look_at = LOOK_AT
        self._server.initial_camera.fov = FIELD_OF_VIEW
        self.scene.set_up_direction("+z")
        self._light()
        # The floor that receives clicks: an image of one colour, which needs no lighting.
        self.floor = self.scene.add_image(
            "/floor/slab",
            np.full((2, 2, 3), FLOOR_COLOUR, np.uint8),
            400.0,
            400.0,
            format="png",
            wxyz=wxyz_of(LAID_DOWN),
            position=(0.0, 0.0, -0.02),
        )
        self.scene.add_grid(
            "/floor/lines",
            infinite_grid=True,
            cell_size=0.5,
            section_size=1.0,
            cell_color=(218, 222, 225),
            section_color=(196, 201, 206),
            shadow_opacity=0.0,
            fade_distance=40.0,
            position=(0.0, 0.0, -0.01),
        )

    def _light(self) -> None:
        """Use two lights without shadows; shadows and an environment map are slow without a GPU."""
        self.scene.configure_environment_map(None)
        self.scene.configure_default_lights(enabled=False)
        self.scene.add_light_directional(
            "/lights/sun", color=(255, 247, 235), intensity=2.0, position=(-6.0, -9.0, 14.0)
        )
        self.scene.add_light_hemisphere(
            "/lights/sky", sky_color=(240, 246, 255), ground_color=(165, 155, 145), intensity=2.0
        )
