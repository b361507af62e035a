"""Ctrl+C in a Python of its own.

Where pytest runs the work itself, the interrupt may fall into the callback of a weak reference, which drops it, or into
pytest, which ends.
"""

from __future__ import annotations

import signal
import subprocess
import sys
import time


def seconds_to_end(setup: str, work: str, after: float) -> float:
    """Runs ``work`` again and again, sends SIGINT after as many seconds, and returns those until it ended."""
    code = f"""
import signal
signal.signal(signal.SIGINT, signal.default_int_handler)
import lights_camera_models as lcm
import numpy as np
{setup}
print("begun", flush=True)
try:
    while True:
        {work}
except KeyboardInterrupt:
    assert lcm.Scene.new().render((64, 36)).any(), "all is well afterwards"
    print("interrupted", flush=True)
"""
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True) as child:
        try:
            assert child.stdout.readline() == "begun\n"
            time.sleep(after)
            begin = time.monotonic()
            child.send_signal(signal.SIGINT)
            child.wait(60)
            assert child.stdout.readline() == "interrupted\n"
            return time.monotonic() - begin
        finally:
            child.kill()
