"""Messages with what `rclpy` does not hand over: the id of the publisher that sent each."""

from __future__ import annotations

import ctypes
from collections.abc import Iterator
from dataclasses import dataclass

from rclpy.subscription import Subscription

NO_MESSAGE = 401
"""What `rcl` returns where no message waits (RCL_RET_SUBSCRIPTION_TAKE_FAILED)."""


class _Allocator(ctypes.Structure):
    """`rcutils_allocator_t`."""

    _fields_ = tuple((name, ctypes.c_void_p) for name in ("allocate", "free", "reallocate", "zeroed", "state"))


class _Data(ctypes.Structure):
    """`rcutils_uint8_array_t`, which the middleware makes larger where it must."""

    _fields_ = (
        ("buffer", ctypes.c_void_p),
        ("length", ctypes.c_size_t),
        ("capacity", ctypes.c_size_t),
        ("allocator", _Allocator),
    )


class _Info(ctypes.Structure):
    """`rmw_message_info_t` of Jazzy, with room behind it."""

    _fields_ = (
        ("sent", ctypes.c_int64),
        ("arrived", ctypes.c_int64),
        ("number", ctypes.c_uint64),
        ("number_here", ctypes.c_uint64),
        ("middleware", ctypes.c_void_p),
        ("publisher", ctypes.c_uint8 * 16),
        ("room", ctypes.c_uint8 * 64),
    )


@dataclass(frozen=True)
class Taken:
    """A serialized message: its publisher's id and its number among its own, when it was sent and arrived [ns]."""

    data: bytes
    publisher: bytes
    number: int
    sent: int
    arrived: int


class Taker:
    """Takes messages from subscriptions; one thread at a time."""

    def __init__(self) -> None:
        self._rcl = ctypes.CDLL("librcl.so")  # that which rclpy has loaded
        default = ctypes.CDLL("librcutils.so").rcutils_get_default_allocator
        default.restype = _Allocator
        self._data, self._info = _Data(allocator=default()), _Info()

    def taken(self, subscription: Subscription) -> Iterator[Taken]:
        """Messages that wait; RuntimeError where the middleware cannot hand them over."""
        data, info = self._data, self._info
        with subscription.handle:
            at = ctypes.c_void_p(subscription.handle.pointer)
            while not (code := self._rcl.rcl_take_serialized_message(at, ctypes.byref(data), ctypes.byref(info), None)):
                content = ctypes.string_at(data.buffer, data.length)
                yield Taken(content, bytes(info.publisher), info.number, info.sent, info.arrived)
        if code != NO_MESSAGE:
            raise RuntimeError(f"{subscription.topic_name}: a message could not be taken (rcl returned {code})")
