"""The command ``pvfiblets serve``."""

from __future__ import annotations

import contextlib
import logging
import os
import sys
from pathlib import Path
from typing import Any

from pvfiblets.errors import FibletsError
from pvfiblets.support.nifti_space import chosen
from pvfiblets.support.surface_space import tkras_chosen
from pvfiblets.support.vtk_space import unnamed


def serve(
    paths: list[str],
    *,
    volume: list[str],
    mesh: list[str],
    demo: bool,
    host: str,
    port: int,
    root: str,
    token: str,
    token_file: str | None,
    shared: bool,
    limit: int,
    timeout: float,
    upload: int,
    memory: str,
    codec: str,
    look: str | None,
    antialias: str | int | None,
    cluster: str | None,
    draw: str,
    origin: list[str],
    proxy: list[str],
    connections: int,
    connections_by_address: int,
) -> int:
    """Serve files to browsers until interrupted."""
    from pvfiblets.web.server.options import MEBIBYTE, Options, chosen_memory
    from pvfiblets.web.server.tokens import VARIABLE, chosen_token

    options = Options(
        files=[os.path.abspath(path) for path in paths],  # noqa: PTH100 - links are kept, for the names' sake
        volume=[os.path.abspath(path) for path in volume],  # noqa: PTH100
        mesh=[os.path.abspath(path) for path in mesh],  # noqa: PTH100
        demo=demo,
        host=host,
        port=port,
        root=os.path.abspath(root),  # noqa: PTH100
        token=chosen_token(token, token_file, os.environ),
        shared=shared,
        limit=limit,
        timeout=timeout,
        upload=upload * MEBIBYTE,
        memory=chosen_memory(memory, 1 if shared else limit),
        codec=codec,
        draw=draw,
        look=look,
        antialias=antialias,
        cluster=cluster if cluster is None or "://" in cluster else os.path.abspath(cluster),  # noqa: PTH100
        origins=origin,
        connections=connections,
        by_address=connections_by_address,
        proxies=proxy,
        nifti_space=chosen()[0],
        nifti_units=chosen()[1],
        tkras=tkras_chosen(),
        space=unnamed(),
    ).checked()
    try:
        import trame_rca  # noqa: F401
        import trame_vuetify  # noqa: F401
    except ImportError as error:
        raise FibletsError(f"{error}; `pvfiblets serve` needs the web extra: pip install 'pvfiblets[web]'") from error
    if cluster is not None:
        from pvfiblets.cluster.connection import connected

        with connected(cluster, 1, None):
            pass  # a missing scheduler is reported before a browser connects
    named = token_file or (f"the environment variable {VARIABLE}" if os.environ.get(VARIABLE) else None)
    return _run(options, named)


def _run(options: Any, named: str | None) -> int:
    """Serve, and say where; `named` is where people know the token from, if they do."""
    import asyncio
    import signal

    from pvfiblets.web.server import front as server
    from pvfiblets.web.server import tokens

    logging.basicConfig(level=logging.WARNING, format="%(levelname)s: %(message)s")
    logging.getLogger("pvfiblets.web").setLevel(logging.INFO)

    kept: list[Path] = []

    def ready(gate: server.FrontServer) -> None:
        # What is written into a file or to another program others may read, some day.
        if options.token is None or sys.stdout.isatty():
            print(f"Open {gate.url}", flush=True)
        else:
            if named is None:
                kept.append(tokens.keep(options.token, os.environ))
            print(f"Open {gate.address} with the token of {named or kept[0]}", flush=True)
        if options.on_loopback:
            print(
                f"From another machine: ssh -L {gate.port}:127.0.0.1:{gate.port} THIS_MACHINE, then the same address."
            )
        print(memory_of(options), flush=True)
        print("Stop with Ctrl+C.", flush=True)

    async def main() -> None:
        task = asyncio.current_task()
        assert task is not None
        for name in (signal.SIGINT, signal.SIGTERM):
            try:
                asyncio.get_running_loop().add_signal_handler(name, task.cancel)
            except NotImplementedError:  # Windows: KeyboardInterrupt does the same
                break
        await server.serve(options, ready)

    try:
        with contextlib.suppress(asyncio.CancelledError, KeyboardInterrupt):
            asyncio.run(main())
    finally:
        for path in kept:
            tokens.forget(path)
    return 0


def memory_of(options: Any) -> str:
    """Return what a session may have, as a sentence."""
    from pvfiblets.support.memory import shown

    if options.memory is None:
        return "Sessions have no limit of memory: this system cannot hold a process to one."
    return f"A session may have {shown(options.memory)} of memory (--max-memory)."
