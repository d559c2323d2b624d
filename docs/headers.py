"""Pages of the C++ interface: what each header declares, from the XML of doxygen.

breathe would look for the free names of a header in whole namespaces, and show them inside these, once for each header. So they
become a group of the header, under their full names.
"""
import re
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass, field
from pathlib import Path


@dataclass
class Header:
    """Lines and directives of classes, concepts and free names."""

    types: list[tuple[int, str]] = field(default_factory=list)
    members: list[ElementTree.Element] = field(default_factory=list)

    def directives(self, name: str) -> str:
        free = f"```{{doxygengroup}} {name}\n:content-only:\n```\n" if self.members else ""
        return "".join(text for _, text in sorted(self.types)) + free


def read_headers(xml: Path) -> dict[str, Header]:
    """By name as it is included, "apsis/core/errors.hpp". Writes the groups beside the files of doxygen."""
    headers: dict[str, Header] = {}
    for file in xml.glob("*.xml"):  # headers that a text names have no page of their own
        text = file.read_text(encoding="utf-8")
        file.write_text(re.sub(r'<ref refid="\w+_source"[^>]*>(.*?)</ref>', r"\1", text), encoding="utf-8")
    index = ElementTree.parse(xml / "index.xml")
    entries = {entry.get("refid"): entry.get("kind") for entry in index.getroot() if entry.get("kind") != "group"}
    inner = {}
    for name, kind in entries.items():
        if kind not in ("class", "struct", "namespace", "concept"):
            continue
        compound = ElementTree.parse(xml / f"{name}.xml").getroot()[0]
        if kind == "namespace":
            for member in compound.iter("memberdef"):
                member.find("name").text = member.find("qualifiedname").text
                headers.setdefault(member.find("location").get("file"), Header()).members.append(member)
            continue
        place = compound.find("location")
        inner |= {part.get("refid"): part for part in compound.findall("innerclass")}
        text = f"```{{doxygen{kind}}} {compound.findtext('compoundname')}\n:members:\n```\n"
        text = concept(compound) if kind == "concept" else text
        headers.setdefault(place.get("file"), Header()).types.append((int(place.get("line")), (name, text)))
    for header in headers.values():  # types inside types are shown with these
        header.types = [(line, text) for line, (name, text) in header.types if name not in inner]
    write_groups(headers, index, xml)
    return headers


def write_groups(headers: dict[str, Header], index: ElementTree.ElementTree, xml: Path):
    for entry in index.getroot().findall("compound[@kind='group']"):
        index.getroot().remove(entry)
    for name, header in headers.items():
        if not header.members:
            continue
        refid = "group__" + re.sub(r"\W", "_", name)
        entry = ElementTree.SubElement(index.getroot(), "compound", refid=refid, kind="group")
        ElementTree.SubElement(entry, "name").text = name
        document = ElementTree.Element("doxygen", version="1.9.4")
        group = ElementTree.SubElement(document, "compounddef", id=refid, kind="group")
        ElementTree.SubElement(group, "compoundname").text = name
        ElementTree.SubElement(group, "title").text = name
        ElementTree.SubElement(group, "sectiondef", kind="user-defined").extend(
            sorted(header.members, key=lambda m: int(m.find("location").get("line"))))
        ElementTree.ElementTree(document).write(xml / f"{refid}.xml", encoding="unicode")
    index.write(xml / "index.xml", encoding="unicode")


def concept(compound: ElementTree.Element) -> str:
    """breathe has no directive for concepts."""
    parameters = ", ".join(" ".join("".join(part.itertext()) for part in parameter if part.tag in ("type", "declname"))
                           for parameter in compound.find("templateparamlist"))
    about = ["".join(part.itertext()).strip() for tag in ("briefdescription", "detaileddescription")
             for part in compound.find(tag)]
    code = "".join(compound.find("initializer").itertext()).strip().replace("apsis::", "")
    return (f"````{{cpp:concept}} template<{parameters}> {compound.findtext('compoundname')}\n\n" + "\n\n".join(about)
            + f"\n\n```cpp\n{code}\n```\n````\n")
