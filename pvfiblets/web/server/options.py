"""The options of ``pvfiblets serve``, checked before anything starts."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from ipaddress import ip_address
from pathlib import Path
from typing import Any

from pvfiblets.plotting.fiblets.looks import check_look
from pvfiblets.support.memory import CAN_LIMIT, of_machine, parse, shown
from pvfiblets.support.nifti_space import Matrix, Units
from pvfiblets.support.vtk_space import Space
from pvfiblets.web.scene.files.file_kinds import is_tractogram_folder

MEBIBYTE = 1024 * 1024
SMALLEST_MEMORY = 640 * MEBIBYTE
"""Of a session: it has taken 320 MB when its page opens, and OpenGL in software takes some for its pictures."""
SHORTEST_TOKEN = 8  # characters of a token that a person chose
FEWEST_CONNECTIONS = 8  # six at once for a page's files, its WebSocket, and one to spare
CODECS = ("jpeg", "png", "webp")
DRAW = ("auto", "here", "there")


@dataclass(frozen=True)
class Options:
    """The settings of one server; :meth:`checked` lists their errors."""

    files: list[str] = field(default_factory=list)  # what a session opens with; they need not lie under `root`
    volume: list[str] = field(default_factory=list)
    mesh: list[str] = field(default_factory=list)
    demo: bool = False  # open with a made-up tractogram
    host: str = "127.0.0.1"  # where to listen; port 0 lets the system choose
    port: int = 8080
    root: str = "."  # the only folder that browsers may open files from and save to
    token: str | None = None  # what a browser must present; `None` asks for nothing
    shared: bool = False  # all browsers see and steer one session
    limit: int = 8  # the greatest number of sessions at once
    timeout: float = 300.0  # seconds that a session without a browser is kept
    upload: int = 2048 * MEBIBYTE  # the greatest size of an uploaded file, in bytes
    codec: str = "jpeg"  # how pictures travel: 'jpeg', 'png' or 'webp'
    # where pictures are drawn: 'here' on the server, 'there' in browsers that can, 'auto' if they have a graphics card
    draw: str = "auto"
    look: str | None = None  # that lines begin with, as of `plotter.add_fiblets`
    antialias: str | int | None = None  # as of `plotter.picture`; None for the default
    cluster: str | None = None  # address of a dask scheduler, or path of its file, whose workers draw fiblets
    memory: int | None = None  # bytes that a session may have; `None`: no limit
    # other origins that pages may come from, such as that of a proxy which renames the host
    origins: list[str] = field(default_factory=list)
    connections: int = 1000  # the most connections at once, in all and from one address
    by_address: int = 100
    # addresses of trusted proxies: their forwarding headers name the client
    proxies: list[str] = field(default_factory=list)
    nifti_space: Matrix | None = None  # what places images of NIfTI, as of `pvfiblets.nifti_space`
    nifti_units: Units = "mm"
    tkras: bool = False  # whether surfaces of FreeSurfer stay in its surface space
    space: Space | None = None  # of points in VTK's files, of those above, that name none

    @property
    def on_loopback(self) -> bool:
        """Whether only this machine can reach the server."""
        return is_loopback(self.host)

    def checked(self) -> Options:
        """Return these options."""
        if not 0 <= self.port <= 65535:
            raise ValueError(f"--port {self.port}: a port is from 0 to 65535")
        if self.limit < 1:
            raise ValueError(f"--limit {self.limit}: at least one session is needed")
        if not self.timeout > 0.0:
            raise ValueError(f"--timeout {self.timeout:g}: seconds above zero are needed")
        for name, number in (("--connections", self.connections), ("--connections-by-address", self.by_address)):
            if number < FEWEST_CONNECTIONS:
                raise ValueError(f"{name} {number}: a browser alone opens {FEWEST_CONNECTIONS}")
        for proxy in self.proxies:
            _check_address(proxy)
        if self.upload < 0:
            raise ValueError(f"--upload {self.upload}: a size of zero or more is needed")
        if self.memory is not None and not CAN_LIMIT:
            raise ValueError("--max-memory: this system cannot hold a process to it; leave it out")
        if self.memory is not None and self.memory < SMALLEST_MEMORY:
            raise ValueError(
                f"--max-memory {shown(self.memory)}: a session needs {shown(SMALLEST_MEMORY)} before it opens "
                "anything large; give at least that"
            )
        check_look("--look", self.look)
        if self.codec not in CODECS:
            raise ValueError(f"--codec {self.codec!r} is none of {', '.join(CODECS)}")
        if self.draw not in DRAW:
            raise ValueError(f"--draw {self.draw!r} is none of {', '.join(DRAW)}")
        for name, given in (("--shared", self.shared), ("--cluster", self.cluster is not None)):
            if given and self.draw == "there":
                raise ValueError(f"--draw there: with {name} the server draws; leave one of them out")
        if self.token is None and not self.on_loopback:
            raise ValueError(
                f"--token none: {self.host} can be reached from other machines, so a token is needed; "
                "use --token auto, or --host 127.0.0.1 and an SSH tunnel"
            )
        if self.token is not None and len(self.token) < SHORTEST_TOKEN:
            raise ValueError(f"the token: at least {SHORTEST_TOKEN} characters are needed; --token auto makes one")
        if not Path(self.root).is_dir():
            raise NotADirectoryError(
                20, "not a folder; --root names the one that browsers may open files from", self.root
            )
        for path in (*self.files, *self.volume, *self.mesh):
            if not (Path(path).is_file() or is_tractogram_folder(Path(path))):
                raise FileNotFoundError(2, "No such file", path)
        return self

    def as_dict(self) -> dict[str, Any]:
        """Return plain data for :meth:`from_dict` in another process."""
        return asdict(self)

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> Options:
        """Return the options that :meth:`as_dict` gave."""
        return cls(**data)


def chosen_memory(text: str, sessions: int) -> int | None:
    """Return the bytes that ``--max-memory auto|SIZE`` means, for each session; ``None`` where none can be set."""
    # By default, sessions share four fifths of the machine's memory. Few are full at once, so that none has less than a
    # fifth of the machine: four full ones leave the server enough.
    if text != "auto":
        try:
            return parse(text)
        except ValueError as error:
            raise ValueError(f"--max-memory {error}") from None
    machine = of_machine()
    if not CAN_LIMIT or not machine:
        return None
    return max(machine * 4 // 5 // min(sessions, 4), SMALLEST_MEMORY)


def is_loopback(host: str) -> bool:
    """Return whether a host name or address can be reached from this machine only."""
    if host.lower() == "localhost":
        return True
    try:
        return ip_address(host.strip("[]")).is_loopback
    except ValueError:
        return False


def _check_address(proxy: str) -> None:
    try:
        ip_address(proxy)
    except ValueError as error:
        raise ValueError(f"--proxy {proxy!r} is no address; one such as 127.0.0.1 is expected") from error
