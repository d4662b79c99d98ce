"""What the nodes do besides ROS: imports no rclpy."""
