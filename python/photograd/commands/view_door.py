"""Who may come in to the page of `photograd view`: the pages that it has served itself.

A page of any other site that is open in the same browser can send requests to this machine, too. It
cannot choose two headers: Origin, the site that it comes from, and Host, the name that it asked
for. A name that its owner points at this machine (DNS rebinding) still stands in Host. So requests
are answered whose Host is a name of this door, and whose Origin, if there is one, is the same door.

viser has no place to say so. It looks up `serve` of websockets when its server starts, and gets one
here that asks first, and that keeps quiet about broken connections: browsers open spare ones.
"""

from __future__ import annotations

import ipaddress
import logging
import socket
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from importlib import import_module
from typing import Any
from unittest import mock

LOOPBACK_NAMES = ("localhost", "127.0.0.1", "[::1]")


def names_of(host: str) -> tuple[str, ...]:
    """What a browser may call an address that is listened at.

    Args:
        host: as the user gave it; of all addresses ("0.0.0.0" or "::") the machine's name counts.
    """
    bound = f"[{host}]" if ":" in host else host
    machine = (socket.gethostname(), socket.getfqdn()) if listens_everywhere(host) else ()
    return tuple(name.lower() for name in (*LOOPBACK_NAMES, bound, *machine))


def listens_everywhere(host: str) -> bool:
    """Whether an address stands for all of the machine's."""
    return host in ("", "0.0.0.0", "::")


def may_enter(hosts: Sequence[str], origins: Sequence[str], address: str, port: int) -> bool:
    """Whether a request comes from a page of this door, or from no page at all.

    Args:
        hosts, origins: the headers Host and Origin, each as often as it is there.
        address: that is listened at.
        port: that is listened at.
    """
    if len(hosts) != 1 or len(origins) > 1:
        return False
    host = hosts[0].strip().lower()
    if not _is_this_door(host, address, port, port_needed=False):
        return False
    if not origins:
        return True
    scheme, _, site = origins[0].strip().lower().partition("://")
    own = site == host or _is_this_door(site, address, port, port_needed=True)
    return scheme in ("http", "https") and own


def _is_this_door(host: str, address: str, port: int, *, port_needed: bool) -> bool:
    has_port = ":" in host.rpartition("]")[2]
    name, _, number = host.rpartition(":") if has_port else (host, "", "")
    known = name in names_of(address) or (listens_everywhere(address) and _is_address(name))
    return known and (number == f"{port}" if has_port else not port_needed)


def _is_address(name: str) -> bool:
    """Numbers are nobody's to point elsewhere."""
    try:
        ipaddress.ip_address(name.strip("[]"))
    except ValueError:
        return False
    return True


@contextmanager
def guarded(host: str) -> Iterator[None]:
    """Around the start of viser's server.

    Args:
        host: address that it listens at.
    """
    library = import_module("viser.infra._infra").websockets.asyncio.server
    original = library.serve

    def serve(handler: Any, address: str, port: int, **options: Any) -> Any:
        options["process_request"] = _asking(options.get("process_request"), host, port)
        return original(handler, address, port, logger=_quiet_logger(), **options)

    with mock.patch.object(library, "serve", serve):
        yield


def _asking(answer: Callable[[Any, Any], Any] | None, host: str, port: int) -> Any:
    """The function that answers requests, behind the question who asks."""

    def process(connection: Any, request: Any) -> Any:
        headers = request.headers
        if may_enter(headers.get_all("Host"), headers.get_all("Origin"), host, port):
            return None if answer is None else answer(connection, request)
        text = f"photograd view: open http://{LOOPBACK_NAMES[1]}:{port}; other names and pages of "
        return connection.respond(403, f"{text}other sites are refused\n")

    return process


def _quiet_logger() -> logging.Logger:
    logger = logging.getLogger("photograd.view")
    logger.propagate = False
    if not logger.handlers:
        logger.addHandler(logging.NullHandler())
    return logger
