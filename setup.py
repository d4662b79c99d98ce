"""The package as ament_python, colcon and pip see it."""

import sys
from glob import glob
from pathlib import Path
from xml.etree import ElementTree

from setuptools import find_packages, setup

PACKAGE = "pierburg_ros"
MANIFEST = ElementTree.parse(Path(__file__).parent / "package.xml")
"""The one place of the version; ROS and the build farm read it there."""
NODES = ("plant", "controller", "recorder", "monitor", "serial_driver")
COMMANDS = (
    "demo",
    "simulate",
    "experiment",
    "identify",
    "replay",
    "diagnose",
    "fleet",
    "inspect",
    "export",
    "actuator",
    "recover",
    "prove",
    "tune",
)
# colcon and the build farm of ROS call `setup.py install` or `develop`, which put executables into lib/pierburg_ros
# (setup.cfg), where `ros2 run pierburg_ros NAME` finds them. pip never does: with it they would crowd the path.
FOR_ROS_RUN = (
    [
        *(f"{name} = pierburg_ros.starting:{name}" for name in (*NODES, *COMMANDS)),
    ]
    if {"install", "develop"} & set(sys.argv)
    else []
)
ROS_WHEELS = [
    "ros-jazzy-rclpy[fastrtps]",
    "ros-jazzy-std-msgs",
    "ros-jazzy-sensor-msgs",
    "ros-jazzy-std-srvs",
    "ros-jazzy-diagnostic-msgs",
    "ros-jazzy-rosgraph-msgs",
    "ros-jazzy-rcl-interfaces",
    "ros-jazzy-builtin-interfaces",
    "ros-jazzy-lifecycle-msgs",
]
MUJOCO = ["mujoco>=3.13; python_version >= '3.11'"]
FLEET = ["dask", "distributed", "pyarrow", "fsspec", "pandas"]
TEST_TOOLS = [
    *MUJOCO,
    *FLEET,
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
    "polars",
    "duckdb",
]

DOCS = ["sphinx", "myst-parser", "furo"]

setup(
    name=PACKAGE,
    version=MANIFEST.findtext("version"),
    description="Simulate, control and diagnose the Pierburg mechatronic actuator over ROS 2.",
    license="Apache-2.0",
    python_requires=">=3.10,<3.14",
    packages=find_packages(exclude=["test", "test.*"]),
    package_data={
        PACKAGE: [
            "py.typed",
            "actuators/*.yaml",
            "cli/*.html",
            "cli/*.yaml",
            "comparison/*.html",
            "diagnosis/report/*.html",
            "fleets/*.html",
            "fleets/*.js",
            "identification/*.html",
            "pages/*.css",
            "pages/*.html",
            "pages/*.js",
        ]
    },
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (f"share/{PACKAGE}", ["package.xml"]),
        (f"share/{PACKAGE}/launch", glob("launch/*.launch.py")),
        (f"share/{PACKAGE}/layouts", sorted([*glob("layouts/*.json"), *glob("layouts/*.xml")])),
        (f"share/{PACKAGE}/urdf", glob("urdf/*.urdf")),
        (f"share/{PACKAGE}/sros2", glob("sros2/*.policy.xml")),
        (f"share/{PACKAGE}/config", glob("config/*.yaml")),
    ],
    install_requires=[  # the oldest versions that `make lowest` tests
        "setuptools",
        "numpy>=1.26",
        "scipy>=1.11.2",
        "numba>=0.62",
        "mcap>=1.6",
        "rosbags>=0.11.9",
        "plotly>=6.0",
        "matplotlib>=3.8",
        "rich>=13.8",
        "typer>=0.26",
        "pydantic>=2.7",
        "jinja2>=3.1.2",
        "PyYAML>=6.0.1",
        "threadpoolctl>=3.2",
        "zstandard>=0.22",
        "lz4>=4.3.2",
    ],
    extras_require={
        "ros": ROS_WHEELS,
        "test": TEST_TOOLS,
        "docs": DOCS,
        "tables": ["pandas"],
        "fleet": FLEET,
        "mujoco": MUJOCO,
        "rerun": ["rerun-sdk>=0.24"],
    },
    entry_points={
        "console_scripts": ["pierburg = pierburg_ros.starting:pierburg", *FOR_ROS_RUN],
    },
    zip_safe=True,
)
