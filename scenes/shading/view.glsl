// A pinhole camera that may be skewed or mirrored: a screen camera or one face of a cube.

struct View {
  vec4 origin;   // xyz; w: near plane distance in metres along forward
  vec4 forward;  // xyz unit vector; w: width of a sample's cone per metre of distance
  vec4 right;    // xyz, d(direction)/ds
  vec4 down;     // xyz, d(direction)/dt
};

// st in [-1,1]^2 with t = -1 at the top (first) row. Not normalised: its component along forward is 1.
PB_FUNC vec3 viewDirection(View view, vec2 st) {
  return vec3(view.forward) + st.x * vec3(view.right) + st.y * vec3(view.down);
}

// Clip position with reversed depth and no far plane: depth = near / distance along forward, 1 at the near plane.
// Clip y grows downwards, so that row 0 in memory is the top row.
PB_FUNC vec4 clipFromWorldPosition(View view, vec3 p) {
  vec3 d = p - vec3(view.origin);
  vec3 right = vec3(view.right);
  vec3 down = vec3(view.down);
  return vec4(dot(d, right) / dot(right, right), dot(d, down) / dot(down, down), view.origin.w, dot(d, vec3(view.forward)));
}
