"""Mesh files of a URDF: found where PyBullet would find them, so that the rewritten text may lie elsewhere."""

from __future__ import annotations

import os
import xml.etree.ElementTree as ET
from pathlib import Path
from urllib.parse import unquote, urlsplit

from tensegym.errors import FlexureError

from .urdf_xml import title

READ = (".obj", ".stl", ".dae", ".cdf")  # by PyBullet


def resolve_meshes(root: ET.Element, folder: Path, what: str) -> list[str]:
    """Make the paths of meshes and textures absolute, in place.

    Args:
        root: the URDF.
        folder: where its file lies.
        what: names it in an error.

    Returns:
        A line for every texture that is left out.

    Raises:
        FlexureError: for a mesh that is not there or of a kind that the engine does not read, naming link and path.
    """
    notes = []
    for link in root.findall("link"):
        for mesh in link.iter("mesh"):
            name = mesh.get("filename", "")
            path = find_file(name, folder)
            if path is None:
                raise FlexureError(f"{what}: {title(link)}: no mesh file {name[:200]!r} beside the URDF, above it or "
                                   "in a folder of ROS_PACKAGE_PATH")  # fmt: skip
            if path.suffix.lower() not in READ:
                raise FlexureError(f"{what}: {title(link)}: mesh {name[:200]!r} is none of {', '.join(READ)}")
            mesh.set("filename", str(path))
    for material in root.iter("material"):
        for texture in material.findall("texture"):
            path = find_file(texture.get("filename", ""), folder)
            if path is None:
                notes.append(f"texture {texture.get('filename', '')[:200]!r} is not there: left out")
                material.remove(texture)
            else:
                texture.set("filename", str(path))
    return notes


def find_file(name: str, folder: Path) -> Path | None:
    """The file that a URDF in ``folder`` means by a path, a file:// address, or a package:// or model:// one."""
    scheme, _, rest = name.partition("://")
    if not rest:
        scheme, rest = "", name
    if scheme == "file":
        rest = unquote(urlsplit(name).path)
    elif scheme not in ("", "package", "model"):
        return None
    packages = [Path(entry) for entry in os.environ.get("ROS_PACKAGE_PATH", "").split(os.pathsep) if entry]
    above = [folder.resolve(), *folder.resolve().parents]
    for start in [*above, *packages]:
        path = start / rest  # an absolute path stays what it is
        if rest and path.is_file():
            return path.resolve()
    return None
