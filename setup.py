"""The package as ament_python, colcon and pip see it."""

from glob import glob

from setuptools import find_packages, setup

PACKAGE = "pierburg_ros"
COMMANDS = ("demo", "simulate", "experiment", "identify", "replay", "diagnose", "prove", "tune")
ROS_WHEELS = [
    "ros-jazzy-rclpy[fastrtps]",
    "ros-jazzy-std-msgs",
    "ros-jazzy-sensor-msgs",
    "ros-jazzy-std-srvs",
    "ros-jazzy-diagnostic-msgs",
    "ros-jazzy-rosgraph-msgs",
    "ros-jazzy-rcl-interfaces",
    "ros-jazzy-builtin-interfaces",
]
TEST_TOOLS = [
    "pytest",
    "pytest-rerunfailures",
    "pytest-xdist",
    "hypothesis",
    "ruff",
    "mypy",
    "types-PyYAML",
    "scikit-fuzzy",
    "networkx",
    "packaging",
]

setup(
    name=PACKAGE,
    version="0.1.0",
    description="Simulate, control and diagnose the Pierburg mechatronic actuator over ROS 2.",
    license="Apache-2.0",
    maintainer="pierburg_ros developers",
    maintainer_email="maintainers@pierburg-ros.example.org",
    python_requires=">=3.10,<3.14",
    packages=find_packages(exclude=["test", "test.*"]),
    package_data={PACKAGE: ["py.typed", "actuators/*.yaml", "diagnosis/report/*.html", "cli/*.html"]},
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (f"share/{PACKAGE}", ["package.xml"]),
        (f"share/{PACKAGE}/launch", glob("launch/*.launch.py")),
        (f"share/{PACKAGE}/urdf", glob("urdf/*.urdf")),
        (f"share/{PACKAGE}/sros2", glob("sros2/*.policy.xml")),
        (f"share/{PACKAGE}/config", glob("config/*.yaml")),
    ],
    install_requires=[
        "setuptools",
        "numpy",
        "scipy",
        "numba",
        "mcap>=1.6",
        "rosbags",
        "plotly",
        "matplotlib",
        "rich",
        "typer",
        "pydantic>=2",
        "jinja2",
        "PyYAML",
        "threadpoolctl",
        "zstandard",
    ],
    extras_require={"ros": ROS_WHEELS, "test": TEST_TOOLS, "benchmarks": ["mujoco"]},
    entry_points={
        "console_scripts": [
            "pierburg = pierburg_ros.cli.app:main",
            "plant = pierburg_ros.nodes.plant:main",
            "controller = pierburg_ros.nodes.controller:main",
            "recorder = pierburg_ros.nodes.recorder:main",
            "monitor = pierburg_ros.nodes.monitor:main",
            "serial_driver = pierburg_ros.nodes.serial_driver:main",
            *(f"{name} = pierburg_ros.cli.app:{name}" for name in COMMANDS),
        ]
    },
    zip_safe=True,
)
