"""A cable between a browser and a server on loopback, which tests can cut."""

import contextlib
import socket
import threading


class Cable:
    """Passes on what comes to a port of its own, until it is cut.

    Parameters
    ----------
    port : int
        Of the server.

    Attributes
    ----------
    whole : bool
        While it is not, connections are refused, and those there were are gone.
    refused : int
        How many connections were.
    """

    def __init__(self, port: int) -> None:
        self._target = ("127.0.0.1", port)
        self.whole, self.refused = True, 0
        self._open: list[socket.socket] = []
        self._passes = threading.Event()
        self._passes.set()
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.port = self._listener.getsockname()[1]
        threading.Thread(target=self._accept, daemon=True).start()

    def _accept(self) -> None:
        with contextlib.suppress(OSError):
            while True:
                near, _ = self._listener.accept()
                if not self.whole:
                    self.refused += 1
                    near.close()
                    continue
                far = socket.create_connection(self._target)
                self._open += [near, far]
                for pair in ((near, far), (far, near)):
                    threading.Thread(target=self._pass_on, args=pair, daemon=True).start()

    def _pass_on(self, source: socket.socket, target: socket.socket) -> None:
        with contextlib.suppress(OSError):
            while data := source.recv(65536):
                self._passes.wait()
                target.sendall(data)
            self._passes.wait()
            target.shutdown(socket.SHUT_WR)

    def cut(self) -> None:
        self.whole = False
        for one in self._open:
            with contextlib.suppress(OSError):
                one.shutdown(socket.SHUT_RDWR)
            one.close()
        self._open.clear()

    def drop(self) -> None:
        """Lose all that is sent, without a word to either end; what was sent comes late, once it is mended."""
        self._passes.clear()

    def mend(self) -> None:
        self.whole = True
        self._passes.set()

    def close(self) -> None:
        self._passes.set()
        self.cut()
        self._listener.close()
