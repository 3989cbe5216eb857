"""The client for asyncio: `client = await rmac.aio.connect("host:7402")`. It shares all but sockets and waiting with the
blocking one."""

from rmac.aio.client import Client, connect
from rmac.aio.run import Run

__all__ = ["Client", "Run", "connect"]
