"""One leaf as a chain of elements, condensed to its two ends, compiled.

The chain's tangent is block tridiagonal, so its inner nodes are eliminated one by one (O(n), no assembled matrix). By
Haynsworth's theorem the negative pivots met on the way, here and in frame.py, add up to the negative eigenvalues of the
whole tangent, which is how instability is seen.
"""

from __future__ import annotations

from tensegym.compiled import kernel

from .beam import OPTIONS, element

# columns of leaf_real
COS, SIN, AX, AY, BX, BY = range(6)
EA, EI, L0, AT = range(4)  # columns of pieces


@kernel(**OPTIONS)
def condense(nodes, axial, real, pieces, count, held, strains, back, ends, loads):
    """Eliminate the inner nodes of one leaf; returns the number of negative pivots.

    nodes (n + 1, 3) x, y, turn; pieces (n, 4) the elements; axial (n,) the geometric axial force; ``held``: node 0 is
    on the ground, its terms are skipped. Out: strains (n, 5) gradient of eps and the axial force; back (n + 2, 21) what
    ``recover`` needs, the last row scratch; ends (3, 9) the condensed blocks S00, S0n, Snn, each 3 x 3 row-major; loads
    (4, 3) condensed residuals at both ends, then the raw ones.
    """
    cos0, sin0 = real[COS], real[SIN]
    negative = 0
    for i in range(count):
        x, y = nodes[i + 1, 0] - nodes[i, 0], nodes[i + 1, 1] - nodes[i, 1]
        out = back[count + 1]
        element(x, y, nodes[i, 2], nodes[i + 1, 2], pieces[i, L0], cos0, sin0, pieces[i, EA], pieces[i, EI],
                axial[i], out)  # fmt: skip
        strains[i, 0], strains[i, 1], strains[i, 2] = out[14], out[15], out[16]
        strains[i, 3], strains[i, 4] = out[17], out[18]
        fx, fy, m1, m2 = out[0], out[1], out[2], out[3]
        xx, xy, yy, x1, y1 = out[4], out[5], out[6], out[7], out[8]
        x2, y2, k11, k12, k22 = out[9], out[10], out[11], out[12], out[13]
        # element blocks: first node 11 = [xx xy -x1; xy yy -y1; -x1 -y1 k11], second 22 = [xx xy x2; .. yy y2; .. k22],
        # coupling 12 = [-xx -xy -x2; -xy -yy -y2; x1 y1 k12]
        if i == 0:
            loads[2, 0], loads[2, 1], loads[2, 2] = -fx, -fy, m1
            r0x, r0y, r0m = -fx, -fy, m1
            s00, s01, s02, s11, s12, s22 = xx, xy, -x1, yy, -y1, k11
            c00, c01, c02, c10, c11, c12, c20, c21, c22 = -xx, -xy, -x2, -xy, -yy, -y2, x1, y1, k12
            d00, d01, d02, d11, d12, d22 = xx, xy, x2, yy, y2, k22
            rx, ry, rm = fx, fy, m2
            continue
        # the node between: its own block d (+ element's first node), coupling c to node 0 and e to node i + 1
        d00, d01, d02, d11, d12, d22 = d00 + xx, d01 + xy, d02 - x1, d11 + yy, d12 - y1, d22 + k11
        rx, ry, rm = rx - fx, ry - fy, rm + m1
        # L D L^T of the 3 x 3 block
        p0 = d00
        l10, l20 = d01 / p0, d02 / p0
        p1 = d11 - l10 * d01
        q = d12 - l10 * d02
        l21 = q / p1
        p2 = d22 - l20 * d02 - l21 * q
        if p0 < 0:
            negative += 1
        if p1 < 0:
            negative += 1
        if p2 < 0:
            negative += 1
        # explicit inverse of the block (symmetric): inv = L^-T D^-1 L^-1
        i0, i1, i2 = 1 / p0, 1 / p1, 1 / p2
        g = l10 * l21 - l20
        n22 = i2
        n12 = -l21 * i2
        n02 = g * i2
        n11 = i1 + l21 * l21 * i2
        n01 = -l10 * i1 - g * l21 * i2
        n00 = i0 + l10 * l10 * i1 + g * g * i2
        row = back[i]
        # du_i = t - A du_0 - B du_(i+1);  B = inv e with e = [-xx -xy -x2; -xy -yy -y2; x1 y1 k12]
        b00 = -n00 * xx - n01 * xy + n02 * x1
        b01 = -n00 * xy - n01 * yy + n02 * y1
        b02 = -n00 * x2 - n01 * y2 + n02 * k12
        b10 = -n01 * xx - n11 * xy + n12 * x1
        b11 = -n01 * xy - n11 * yy + n12 * y1
        b12 = -n01 * x2 - n11 * y2 + n12 * k12
        b20 = -n02 * xx - n12 * xy + n22 * x1
        b21 = -n02 * xy - n12 * yy + n22 * y1
        b22 = -n02 * x2 - n12 * y2 + n22 * k12
        tx = -(n00 * rx + n01 * ry + n02 * rm)
        ty = -(n01 * rx + n11 * ry + n12 * rm)
        tm = -(n02 * rx + n12 * ry + n22 * rm)
        row[0], row[1], row[2] = tx, ty, tm
        row[3], row[4], row[5], row[6], row[7], row[8] = b00, b01, b02, b10, b11, b12
        row[9], row[10], row[11] = b20, b21, b22
        if not held:
            # A = inv c^T (c couples node 0 to this node)
            a00, a01, a02 = (n00 * c00 + n01 * c01 + n02 * c02, n00 * c10 + n01 * c11 + n02 * c12,
                             n00 * c20 + n01 * c21 + n02 * c22)  # fmt: skip
            a10, a11, a12 = (n01 * c00 + n11 * c01 + n12 * c02, n01 * c10 + n11 * c11 + n12 * c12,
                             n01 * c20 + n11 * c21 + n12 * c22)  # fmt: skip
            a20, a21, a22 = (n02 * c00 + n12 * c01 + n22 * c02, n02 * c10 + n12 * c11 + n22 * c12,
                             n02 * c20 + n12 * c21 + n22 * c22)  # fmt: skip
            row[12], row[13], row[14], row[15], row[16], row[17] = a00, a01, a02, a10, a11, a12
            row[18], row[19], row[20] = a20, a21, a22
            s00 -= c00 * a00 + c01 * a10 + c02 * a20
            s01 -= c00 * a01 + c01 * a11 + c02 * a21
            s02 -= c00 * a02 + c01 * a12 + c02 * a22
            s11 -= c10 * a01 + c11 * a11 + c12 * a21
            s12 -= c10 * a02 + c11 * a12 + c12 * a22
            s22 -= c20 * a02 + c21 * a12 + c22 * a22
            r0x += c00 * tx + c01 * ty + c02 * tm
            r0y += c10 * tx + c11 * ty + c12 * tm
            r0m += c20 * tx + c21 * ty + c22 * tm
            c00, c01, c02 = (-(c00 * b00 + c01 * b10 + c02 * b20), -(c00 * b01 + c01 * b11 + c02 * b21),
                             -(c00 * b02 + c01 * b12 + c02 * b22))  # fmt: skip
            c10, c11, c12 = (-(c10 * b00 + c11 * b10 + c12 * b20), -(c10 * b01 + c11 * b11 + c12 * b21),
                             -(c10 * b02 + c11 * b12 + c12 * b22))  # fmt: skip
            c20, c21, c22 = (-(c20 * b00 + c21 * b10 + c22 * b20), -(c20 * b01 + c21 * b11 + c22 * b21),
                             -(c20 * b02 + c21 * b12 + c22 * b22))  # fmt: skip
        # next node: 22 - e^T B, residual f2 + e^T t
        d00 = xx + xx * b00 + xy * b10 - x1 * b20
        d01 = xy + xx * b01 + xy * b11 - x1 * b21
        d02 = x2 + xx * b02 + xy * b12 - x1 * b22
        d11 = yy + xy * b01 + yy * b11 - y1 * b21
        d12 = y2 + xy * b02 + yy * b12 - y1 * b22
        d22 = k22 + x2 * b02 + y2 * b12 - k12 * b22
        rx = fx - xx * tx - xy * ty + x1 * tm
        ry = fy - xy * tx - yy * ty + y1 * tm
        rm = m2 - x2 * tx - y2 * ty + k12 * tm
    loads[3, 0], loads[3, 1], loads[3, 2] = fx, fy, m2
    loads[0, 0], loads[0, 1], loads[0, 2] = r0x, r0y, r0m
    loads[1, 0], loads[1, 1], loads[1, 2] = rx, ry, rm
    ends[0, 0], ends[0, 1], ends[0, 2], ends[0, 4], ends[0, 5], ends[0, 8] = s00, s01, s02, s11, s12, s22
    ends[0, 3], ends[0, 6], ends[0, 7] = s01, s02, s12
    ends[1, 0], ends[1, 1], ends[1, 2], ends[1, 3], ends[1, 4], ends[1, 5] = c00, c01, c02, c10, c11, c12
    ends[1, 6], ends[1, 7], ends[1, 8] = c20, c21, c22
    ends[2, 0], ends[2, 1], ends[2, 2], ends[2, 4], ends[2, 5], ends[2, 8] = d00, d01, d02, d11, d12, d22
    ends[2, 3], ends[2, 6], ends[2, 7] = d01, d02, d12
    return negative


@kernel(**OPTIONS)
def recover(nodes, axial, pieces, count, held, strains, back, first, last):
    """Move the inner nodes by the increments that follow from those of the ends (3,) and renew ``axial``; in place.

    Returns the largest increment, lengths counted in units of the element's rest length. The end nodes are left to the
    caller, who moves them rigidly with their bodies.
    """
    vx, vy, vm = last[0], last[1], last[2]
    ax, ay, am = first[0], first[1], first[2]
    largest = 0.0
    for i in range(count - 1, -1, -1):
        if i == 0:
            ux, uy, um = ax, ay, am
        else:
            row = back[i]
            ux = row[0] - row[3] * vx - row[4] * vy - row[5] * vm
            uy = row[1] - row[6] * vx - row[7] * vy - row[8] * vm
            um = row[2] - row[9] * vx - row[10] * vy - row[11] * vm
            if not held:
                ux -= row[12] * ax + row[13] * ay + row[14] * am
                uy -= row[15] * ax + row[16] * ay + row[17] * am
                um -= row[18] * ax + row[19] * ay + row[20] * am
            nodes[i, 0] += ux
            nodes[i, 1] += uy
            nodes[i, 2] += um
            largest = max(largest, abs(um), abs(ux) / pieces[i, L0], abs(uy) / pieces[i, L0])
        grow = strains[i, 0] * (vx - ux) + strains[i, 1] * (vy - uy) + strains[i, 2] * um + strains[i, 3] * vm
        axial[i] = strains[i, 4] + pieces[i, EA] * grow
        vx, vy, vm = ux, uy, um
    return largest
