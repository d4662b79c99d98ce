"""ROS shells: the plant, the controller and the recorder as nodes. The only folder that imports rclpy."""
