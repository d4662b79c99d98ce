"""Whether recordings are what they are read as: the audit before anything is concluded from them."""

from pierburg_ros.audit.audit import audit
from pierburg_ros.audit.fault import Fault

__all__ = ["Fault", "audit"]
