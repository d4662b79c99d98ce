"""What is in a file, what each number of it could be, and a signal map to edit."""

from pierburg_ros.recording.inspection.content import FieldContent, TopicContent
from pierburg_ros.recording.inspection.inspect import Inspection, inspect

__all__ = ["FieldContent", "Inspection", "TopicContent", "inspect"]
