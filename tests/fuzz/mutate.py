"""mutate.py IN OUT SEED: a copy with a few bytes changed, a stretch cut out or repeated, or the end missing. The same seed, the same copy."""
import random
import sys

r = random.Random(int(sys.argv[3]))
data = bytearray(open(sys.argv[1], "rb").read())
# The header is short and decides most: in half of the copies every other change goes there. The others keep it, and the place of
# every chunk, so that what decompresses and reads pixels gets to see them.
header = min(len(data), 2500)
anywhere = r.random() < 0.5
for _ in range(r.choice([1, 1, 2, 4, 16])):
    if not data:
        break
    if anywhere:
        at = r.randrange(min(len(data), header)) if r.random() < 0.5 else r.randrange(len(data))
    else:
        at = r.randrange(min(header, len(data) - 1), len(data))
    what = r.randrange(6 if anywhere else 3)
    if what == 0:
        data[at] ^= 1 << r.randrange(8)
    elif what == 1:
        data[at] = r.choice([0, 1, 127, 128, 255])
    elif what == 2:
        value = r.choice([0, 1, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, r.getrandbits(32)])
        data[at : at + 4] = value.to_bytes(4, "little")
    elif what == 3:
        del data[at : at + r.randrange(1, 64)]
    elif what == 4:
        data[at:at] = data[at : at + r.randrange(1, 64)]
    elif r.random() < 0.3:
        del data[at:]
    if not data:
        data = bytearray(b"\0")
open(sys.argv[2], "wb").write(data)
