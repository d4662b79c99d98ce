"""A serial line as a file: raw bytes, nothing waits."""

from __future__ import annotations

import os
import select
import termios
import tty
from types import TracebackType

from pierburg_ros.errors import InputError

LARGEST_READ = 4096
"""Most bytes of one reading."""


class Unplugged(Exception):
    """The line is gone."""


class Port:
    """An open line. `read` and `write` raise Unplugged where it is no longer there."""

    def __init__(self, path: str, speed: int) -> None:
        """Open `path` at `speed` [baud]; Unplugged where it is not there, InputError where it is no serial line."""
        rate = getattr(termios, f"B{speed}", None)
        if rate is None:
            raise InputError(f"{speed} baud is no speed of this machine's lines; give one such as 115200 or 921600.")
        try:
            self._file = os.open(path, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
        except PermissionError as error:
            raise InputError(f"{path} may not be opened; add yourself to its group, often dialout.") from error
        except OSError as error:
            raise Unplugged(f"{path}: {error.strerror}") from error
        try:
            tty.setraw(self._file, termios.TCSANOW)
            settings = termios.tcgetattr(self._file)
            settings[2] |= termios.CLOCAL | termios.CREAD
            settings[4] = settings[5] = rate
            termios.tcsetattr(self._file, termios.TCSANOW, settings)
            termios.tcflush(self._file, termios.TCIFLUSH)
        except termios.error as error:
            os.close(self._file)
            raise InputError(f"{path} is no serial line; give a device such as /dev/ttyACM0.") from error

    def read(self, patience: float) -> bytes:
        """What has arrived, after waiting `patience` [s] at most; empty where nothing came."""
        try:
            if not select.select([self._file], [], [], patience)[0]:
                return b""
            data = os.read(self._file, LARGEST_READ)
        except OSError as error:
            raise Unplugged(str(error.strerror)) from error
        if not data:
            raise Unplugged("end of the line")
        return data

    def write(self, data: bytes) -> bool:
        """Send all of `data`, or say False where the line is too busy to take it whole."""
        try:
            return os.write(self._file, data) == len(data)
        except BlockingIOError:
            return False
        except OSError as error:
            raise Unplugged(str(error.strerror)) from error

    def close(self) -> None:
        """Let go of the line."""
        os.close(self._file)

    def __enter__(self) -> Port:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self.close()
