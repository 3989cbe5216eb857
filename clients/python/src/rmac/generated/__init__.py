"""Written by clients/python/generate.py from rpc.discover; do not edit."""

API_VERSION = "0.2.0"
