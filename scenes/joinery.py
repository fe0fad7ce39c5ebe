"""What the house and the interior are furnished with: windows, railings, chairs, shelves. Materials go by name."""

from modelling import *  # noqa: F403


def window(width, height, columns, rows, sill=True, frame=0.07, depth=0.09):
    """Frame, mullions, transoms, panes; its lower left corner at the origin, its middle on z = 0."""
    w = Mesh()
    bar = lambda bw, bh, x, y, d=depth: w.add(block(bw, bh, d, "frame"), (x, y, 0))
    bar(frame, height, frame / 2, 0)
    bar(frame, height, width - frame / 2, 0)
    bar(width - 2 * frame, frame, width / 2, 0)
    bar(width - 2 * frame, frame, width / 2, height - frame)
    thin = 0.035
    for c in range(1, columns):
        bar(thin, height - 2 * frame, frame + (width - 2 * frame) * c / columns, frame, 0.06)
    for r in range(1, rows):
        for c in range(columns):
            left = frame + (width - 2 * frame) * c / columns + (thin / 2 if c else 0)
            right = frame + (width - 2 * frame) * (c + 1) / columns - (thin / 2 if c < columns - 1 else 0)
            bar(right - left, thin, (left + right) / 2, frame + (height - 2 * frame) * r / rows - thin / 2, 0.05)
    w.add(block(width - 2 * frame, height - 2 * frame, 0.016, "glass"), (width / 2, frame, 0))
    if sill:
        w.add(block(width + 0.16, 0.05, 0.22, "stone"), (width / 2, -0.05, 0.12))
    return w


def railing(length, height=1.0, gap=0.11):
    r = Mesh()
    r.add(block(length, 0.05, 0.06, "metal"), (0, height - 0.05, 0))
    r.add(block(length, 0.03, 0.04, "metal"), (0, 0.08, 0))
    count = int(length / gap)
    for i in range(count + 1):
        r.add(block(0.014, height - 0.13, 0.014, "metal"), (-length / 2 + 0.02 + (length - 0.04) * i / count, 0.11, 0))
    return r


def chair():
    c = Mesh()
    c.add(block(0.44, 0.035, 0.42, "timber"), (0, 0.44, 0))
    for x in (-0.19, 0.19):
        c.add(block(0.035, 0.44, 0.035, "timber"), (x, 0, 0.18))
        c.add(block(0.035, 0.95, 0.035, "timber"), (x, 0, -0.19))
    for y in (0.6, 0.74, 0.88):
        c.add(block(0.34, 0.05, 0.02, "timber"), (0, y, -0.19))
    return c


def bookshelf():
    s = Mesh()
    for x in (-0.6, 0.6):
        s.add(block(0.03, 2.0, 0.32, "timber"), (x, 0, 0))
    for i in range(6):
        s.add(block(1.17, 0.03, 0.3, "timber"), (0, 0.06 + 0.38 * i, 0))
    s.add(block(1.17, 2.0, 0.015, "timber"), (0, 0, -0.15))
    for i in range(5):
        x = -0.55
        k = 0
        while x < 0.5:
            w = 0.03 + 0.025 * ((i * 7 + k * 5) % 4) / 3
            s.add(block(w, 0.2 + 0.1 * ((i * 3 + k * 11) % 5) / 4, 0.2, ("door", "frame", "shutter", "board")[(i + k) % 4]), (x + w / 2, 0.09 + 0.38 * i, 0))
            x += w + 0.004
            k += 1
    return s
