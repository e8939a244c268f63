"use strict";
// Draws a specimen of a report: beads as spheres that each fragment computes for itself, bonds as cylinders
// seen from their side, by parallel projection. Lengths in mm.

const beadVertex = `#version 300 es
layout(location=0) in vec2 corner;
layout(location=1) in vec3 centre;
layout(location=2) in float radius;
layout(location=3) in float value;
uniform vec3 low, size, middle;
uniform mat3 turn;
uniform vec2 scale, shift;
uniform float depth, swell;
out vec2 at;
out float grey;
flat out vec3 eye;
flat out float reach;
flat out int bead;
void main() {
  eye = turn * (low + centre * size - middle);
  reach = radius * swell;
  at = corner;
  grey = value;
  bead = gl_VertexID / 4;
  gl_Position = vec4((eye.xy + reach * corner + shift) * scale, -eye.z / depth, 1.0);
}`;

const colourOf = `
uniform sampler2D colours;
uniform vec2 range;
uniform float unit, row;
vec3 colourOf(float value) {
  if (abs(value) > 60000.0) return vec3(0.6);
  float t = clamp((value * unit - range.x) / (range.y - range.x), 0.0, 1.0);
  return texture(colours, vec2((0.5 + t * 64.0) / 65.0, row)).rgb;
}`;

const beadFragment = `#version 300 es
precision highp float;
in vec2 at;
in float grey;
flat in vec3 eye;
flat in float reach;
flat in int bead;
uniform float depth;
uniform vec4 cut;
uniform int chosen;
${colourOf}
out vec4 colour;
void main() {
  float beside = dot(at, at);
  if (beside > 1.0) discard;
  vec3 normal = vec3(at, sqrt(1.0 - beside));
  vec3 hit = eye + reach * normal;
  float beyond = dot(cut.xyz, hit) - cut.w;
  if (beyond > 0.0) {  // the ray goes on to the plane and meets the bead's inside there, or nothing
    if (cut.z <= 0.0) discard;
    hit.z -= beyond / cut.z;
    vec3 from = hit - eye;
    if (dot(from, from) > reach * reach) discard;
    normal = cut.xyz;
  }
  float light = 0.35 + 0.65 * normal.z;
  colour = vec4(colourOf(grey) * light, 1.0);
  if (bead == chosen) colour.rgb = beside > 0.64 ? vec3(0.0) : mix(colour.rgb, vec3(1.0), 0.35);
  gl_FragDepth = 0.5 - 0.5 * hit.z / depth;
}`;

const bondVertex = `#version 300 es
layout(location=0) in vec2 corner;
layout(location=1) in vec3 first;
layout(location=2) in vec3 second;
layout(location=3) in float value;
layout(location=4) in float state;
uniform vec3 low, size, middle;
uniform mat3 turn;
uniform vec2 scale, shift;
uniform float depth, width;
out float across;
out float grey;
out vec3 place;
flat out float kind;
void main() {
  vec3 a = turn * (low + first * size - middle), b = turn * (low + second * size - middle);
  vec2 along = b.xy - a.xy;
  vec2 aside = length(along) > 0.0 ? normalize(vec2(-along.y, along.x)) : vec2(1.0, 0.0);
  place = mix(a, b, 0.5 + 0.5 * corner.y);
  place.xy += width * corner.x * aside;
  across = corner.x;
  grey = value;
  kind = state;
  gl_Position = vec4((place.xy + shift) * scale, -place.z / depth, 1.0);
}`;

const bondFragment = `#version 300 es
precision highp float;
in float across;
in float grey;
in vec3 place;
flat in float kind;
uniform vec4 cut;
uniform bool by_value;
${colourOf}
out vec4 colour;
void main() {
  if (dot(cut.xyz, place) > cut.w) discard;
  vec3 own = kind == 1.0 ? vec3(0.84, 0.1, 0.08) : kind == 2.0 ? vec3(0.35, 0.55, 0.85) : vec3(0.45);
  colour = vec4((by_value ? colourOf(grey) : own) * (0.4 + 0.6 * sqrt(max(0.0, 1.0 - across * across))), 1.0);
}`;
