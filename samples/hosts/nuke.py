# SPDX-License-Identifier: CC0-1.0
"""ssdo-filter on a Read of Nuke. Its syntax was checked; it was NOT RUN in Nuke.

Put this file as ssdo_nuke.py on Nuke's plug-in path and this into menu.py:

    import ssdo_nuke
    nuke.menu("Nodes").addCommand("Filter/ssdo-filter", "ssdo_nuke.create()")

Select a Read and make the node; "Filter" runs the program on the Read's file, or on its sequence, and reads the result back.
"""
import os
import subprocess

import nuke

METHODS = ["arc", "ssdo", "s3ho", "alchemy", "hemisphere", "hbao", "gtao", "bitmask"]


def create():
    read = nuke.selectedNode()
    node = nuke.nodes.NoOp(name="ssdo", inputs=[read])
    node.addKnob(nuke.File_Knob("result", "output"))
    node.addKnob(nuke.Enumeration_Knob("method", "method", METHODS))
    node.addKnob(nuke.String_Knob("reach", "radius", "auto"))
    node.addKnob(nuke.Enumeration_Knob("quality", "quality", ["standard", "draft", "high"]))
    node.addKnob(nuke.File_Knob("env", "environment"))
    node.addKnob(nuke.String_Knob("layers", "layers", "occlusion,radiance,indirect,composite"))
    node.addKnob(nuke.PyScript_Knob("filter", "Filter", "import ssdo_nuke; ssdo_nuke.run(nuke.thisNode())"))
    stem = os.path.splitext(read["file"].value())[0]
    folder, name = os.path.split(stem)
    node["result"].setValue(os.path.join(folder, "ssdo_" + name + ".exr"))
    return node


def command(node, read):
    """The command line; of a sequence, of all frames of the Read."""
    source, target = read["file"].value(), node["result"].value()
    line = [os.environ.get("SSDO", "ssdo-filter"), "-q", source, "-o", target, "--method", node["method"].value(),
            "--radius", node["reach"].value(), "--quality", node["quality"].value(), "--layers", node["layers"].value()]
    if node["env"].value():
        line += ["--env", node["env"].value()]
    if "#" in source or "%" in source:
        line += ["--frames", "%d-%d" % (read["first"].value(), read["last"].value())]
    return line


def run(node):
    read = node.input(0)
    if read is None or read.Class() != "Read":
        nuke.message("ssdo: the input has to be a Read")
        return
    done = subprocess.run(command(node, read), stderr=subprocess.PIPE, universal_newlines=True)
    if done.returncode:
        nuke.message("ssdo-filter: exit code %d\n%s" % (done.returncode, done.stderr))
        return
    result = nuke.nodes.Read(file=node["result"].value(), first=read["first"].value(), last=read["last"].value(), raw=True)
    result.setXYpos(node.xpos(), node.ypos() + 80)
