// SPDX-License-Identifier: MIT
// The mass of a body from the JSON of `cdprep export NAME.cdp.h5 --for json`. The loaders beside
// this file give it to their engines. In kilograms and metres, and along the axes of the model.

/** Mass, centre, inertia about the centre, and the principal moments. `axes` is the quaternion
 *  x, y, z, w that turns the principal axes into the model. Null for a mesh that is not closed:
 *  engines should then weigh the pieces. */
export function massOf(colliders, density) {
    if (!colliders.mass?.closed) return null;
    const unit = colliders.metres_per_unit ?? 1, { volume, centre, inertia } = colliders.mass;
    const scaled = inertia.map((row) => row.map((x) => density * unit ** 5 * x));
    return { mass: density * unit ** 3 * volume, centre: centre.map((x) => unit * x),
             inertia: scaled, ...principal(scaled) };
}

/** The eigenvalues of a symmetric tensor and their axes, by turns in one plane each (Jacobi). */
function principal(tensor) {
    const a = tensor.map((row) => [...row]);
    let axes = [0, 0, 0, 1];
    for (let sweep = 0; sweep < 12; ++sweep) {
        for (const [i, j, k] of [[0, 1, 2], [1, 2, 0], [2, 0, 1]]) {
            if (a[i][j] === 0) continue;
            const [ii, jj, ij, ik, jk] = [a[i][i], a[j][j], a[i][j], a[i][k], a[j][k]];
            const sign = ii < jj ? -1 : 1;  // by at most an eighth of a turn
            const angle = 0.5 * Math.atan2(2 * sign * ij, sign * (ii - jj));
            const c = Math.cos(angle), s = Math.sin(angle);
            a[i][i] = c * c * ii + 2 * s * c * ij + s * s * jj;
            a[j][j] = s * s * ii - 2 * s * c * ij + c * c * jj;
            a[i][j] = a[j][i] = 0;
            a[i][k] = a[k][i] = c * ik + s * jk;
            a[j][k] = a[k][j] = c * jk - s * ik;
            const turn = [0, 0, 0, Math.cos(angle / 2)];
            turn[k] = Math.sin(angle / 2);
            axes = product(axes, turn);
        }
    }
    return { moments: [0, 1, 2].map((i) => a[i][i]), axes };
}

/** The product of two quaternions. */
function product([x, y, z, w], [a, b, c, d]) {
    return [w * a + x * d + y * c - z * b, w * b - x * c + y * d + z * a,
            w * c + x * b - y * a + z * d, w * d - x * a - y * b - z * c];
}
