"use strict";
// All that was found. A kind of finding is one entry of KINDS, and nothing else.
const dynamics = typeof film.dynamics === "object" ? film.dynamics : {};

function cuttingPart(t) {
  const tool = toolAt(t), body = tool && tool.bodies.find(b => b.kind === "cutting part");
  return body ? [body.name] : [];
}

/// Of each kind its colour, what was `found`, each with `t_s`, and what is told of one:
///   text, why   in the list
///   bodies      that a click colours; none: no one
///   until_s     t_s unless it lasts
///   at_s        where a click goes to; t_s unless told
///   line        of the program; what is shown then unless told
///   place_mm    in the part frame; the tip at `at_s` unless told
const KINDS = {
  collision: {colour: "#d0302a", found: (film.collisions || []).filter(f => f.certain),
    tell: f => ({...f, text: f.depth_mm.toFixed(3) + " mm deep"})},
  possible: {colour: "#e07b2a", found: (film.collisions || []).filter(f => !f.certain),
    tell: f => ({...f, text: f.depth_mm.toFixed(3) + " mm deep"})},
  "near miss": {colour: "#d9b020", found: film.near_misses || [],
    tell: f => ({...f, text: f.distance_mm.toFixed(3) + " mm apart"})},
  overload: {colour: "#8a4fbf", found: film.overloads || [],
    tell: f => ({...f, bodies: cuttingPart(f.t_s),
      text: f.what + " " + figure(f.most) + " of " + figure(f.allowed) + (f.what === "torque" ? " N·m" : " W")})},
  "off path": {colour: "#c2187a", found: dynamics.off_path || [],
    tell: ({t_s, until_s, most_t_s, line, most_mm, allowed_mm}) => ({t_s, until_s, line, at_s: most_t_s,
      bodies: cuttingPart(most_t_s), text: `${figure(most_mm)} of ${figure(allowed_mm)} mm beside its path`})},
  chatter: {colour: "#0f7f8c", found: dynamics.chatter || [],
    tell: ({t_s, until_s, most_t_s, line, frequency_hz, from_percent, rpm, steady_rpm}) => ({t_s, until_s, line, at_s: most_t_s,
      bodies: cuttingPart(most_t_s), text: `${Math.round(frequency_hz)} Hz at ${Math.round(rpm)} rpm, from ${Math.round(from_percent)} % ` +
        "of its depth on" + (steady_rpm ? `; steady at ${Math.round(steady_rpm)} rpm` : "")})},
  stops: {colour: "#20262b", found: dynamics.stopped ? [dynamics.stopped] : [],
    tell: ({t_s, line, why}) => ({t_s, line, text: why})},
  "too hot": {colour: "#a0522d", found: (dynamics.motors || []).filter(motor => motor.overheats),
    tell: motor => ({t_s: film.from_s, until_s: film.to_s, at_s: motor.peak_t_s,
      text: `motor ${motor.bus} ${motor.axis} gives ${figure(motor.rms_nm)} N·m in the mean of the program, and is made for ` +
        `${figure(motor.rated_nm)}; ${figure(motor.peak_nm)} at most`})},
};

/// In the order in which they began.
const findings = Object.entries(KINDS).flatMap(([kind, {found, colour, tell}]) => found.map(each => {
  const told = tell(each), at_s = told.at_s ?? told.t_s;
  return {kind, colour, bodies: [], until_s: told.t_s, line: stepAt(film.lines, at_s), ...told, at_s};
})).sort((a, b) => a.t_s - b.t_s);
