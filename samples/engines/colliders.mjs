// SPDX-License-Identifier: MIT
// Reads the JSON of `cdprep export NAME.cdp.h5 --for json` for the loaders beside this file.

/** Parts and mass in metres and kilograms, along the axes of the model. `moments` are those about
 *  the principal axes. The quaternion `axes`, x, y, z, w, turns these into the model. */
export function inMetres({ name, metres_per_unit, mass, parts }, density) {
    const unit = metres_per_unit ?? 1;
    if (!mass) throw new Error(`${name}: it has no volume, or a mass beyond the range of double`);
    return {
        parts: parts.map(({ name, points }) => ({ name, points: points.map((x) => unit * x) })),
        mass: density * unit ** 3 * mass.volume,
        centre: mass.centre.map((x) => unit * x),
        moments: mass.moments.map((x) => density * unit ** 5 * x),
        axes: mass.axes,
    };
}

/** The largest size of a coordinate. */
export function reachOf(points) {
    return points.reduce((most, x) => Math.max(most, Math.abs(x)), 0);
}
