"""SROS2 policies (schema 0.2.0) from what nodes have on the graph. Knows no ROS."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from xml.etree import ElementTree

VERSION = "0.2.0"
"""Of the schema of policies that SROS2 reads."""


@dataclass(frozen=True)
class Rights:
    """What a node does, as names in its profile: `~/own`, `relative` to the namespace, or `/absolute`."""

    publish: frozenset[str] = frozenset()
    subscribe: frozenset[str] = frozenset()
    reply: frozenset[str] = frozenset()
    request: frozenset[str] = frozenset()

    def __or__(self, other: Rights) -> Rights:
        """Rights of a node that does both."""
        return Rights(
            self.publish | other.publish,
            self.subscribe | other.subscribe,
            self.reply | other.reply,
            self.request | other.request,
        )


ABSOLUTE = ("/diagnostics", "/parameter_events", "/rosout", "/clock", "/recorded_until")
"""Topics that a namespace does not move."""
_GROUPS = (("topics", "publish"), ("topics", "subscribe"), ("services", "reply"), ("services", "request"))


def named(names: Iterable[str], node: str) -> frozenset[str]:
    """Resolved names of the node `node` in the root namespace as a profile has them."""
    own = f"/{node}/"
    return frozenset(
        f"~/{name.removeprefix(own)}" if name.startswith(own) else name if name in ABSOLUTE else name.lstrip("/")
        for name in names
    )


def policy(node: str, rights: Rights) -> str:
    """The policy of one node, in an enclave of its name."""
    root = ElementTree.Element("policy", version=VERSION)
    enclave = ElementTree.SubElement(ElementTree.SubElement(root, "enclaves"), "enclave", path=f"/{node}")
    profile = ElementTree.SubElement(ElementTree.SubElement(enclave, "profiles"), "profile", ns="/", node=node)
    for kind, right in _GROUPS:
        names = getattr(rights, right)
        if names:
            group = ElementTree.SubElement(profile, kind, {right: "ALLOW"})
            for name in sorted(names):
                ElementTree.SubElement(group, kind.removesuffix("s")).text = name
    ElementTree.indent(root)
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{ElementTree.tostring(root, encoding="unicode")}\n'


def rights(text: str) -> Rights:
    """The rights that a policy of one node grants."""
    profile = ElementTree.fromstring(text).find("enclaves/enclave/profiles/profile")
    granted: dict[str, frozenset[str]] = {}
    for kind, right in _GROUPS:
        groups = [] if profile is None else profile.findall(f"{kind}[@{right}='ALLOW']")
        granted[right] = frozenset(item.text or "" for group in groups for item in group)
    return Rights(**granted)
