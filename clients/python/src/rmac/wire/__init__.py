"""The protocol without its sockets: what to send, and what came back means. Blocking and asyncio clients share it."""
