# SPDX-License-Identifier: CC0-1.0
"""ssdo-filter as a SystemCommand of Gaffer. Its syntax was checked; it was NOT RUN in Gaffer.

In the Python editor: exec(open("gaffer.py").read()); filter_node(root, "/shots/in.####.exr", "/shots/lit.####.exr").
The node is dispatched for the frames that are asked for, one frame a command; after it an ImageReader shows the result.
"""
import GafferDispatch
import GafferImage


def filter_node(script, source, target, options="--method arc --quality standard"):
    node = GafferDispatch.SystemCommand("ssdo")
    # Gaffer puts the frame in place of ####, so the program is given the names of single files.
    node["command"].setValue('ssdo-filter -q "%s" -o "%s" %s' % (source, target, options))
    script.addChild(node)
    reader = GafferImage.ImageReader("ssdoResult")
    reader["fileName"].setValue(target)
    script.addChild(reader)
    return node
