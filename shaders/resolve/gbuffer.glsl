// The G-buffer of the engine, read by VTK's own polydata shader.
//
// VTK draws two triangles that cover the rectangle of the viewport in which fiblets can be: pixels outside it cost
// nothing. Every fragment fetches its own texel:
//
//   fibletDepthMap     r32ui   window depth * 4294967295, 0xFFFFFFFF where no fiblet was drawn
//   fibletIdMap        rg32ui  streamline id | unit tangent, data coordinates, octahedral, 2 x 16 bit
//
// and supplies what VTK's lights, passes and selection ask of a fragment:
//
//   vertexVC           position in view coordinates, by the inverse of the projection
//   fibletDepth        window depth; takes the place of gl_FragCoord.z everywhere in VTK's text
//
// 1 - depth is formed on the integers. As 1/distance is linear in depth, the distance of far points
// would lose all its digits to the cancellation in 1 - depth, had it been formed in float32.
//
// Sections: "//@ stage where TAG"; where = before | after | instead of VTK's tag.

//@ vertex after //VTK::CustomUniforms::Dec
uniform vec4 fibletRectangle;      // left, lower, right, upper in [-1, 1]

//@ vertex instead //VTK::PositionVC::Impl
  // Counter-clockwise: 0 lower left, 1 lower right, 2 upper left; 3 upper right, 4 upper left, 5 lower right.
  bool fibletRight = gl_VertexID == 1 || gl_VertexID == 3 || gl_VertexID == 5;
  bool fibletUpper = gl_VertexID >= 2 && gl_VertexID <= 4;
  gl_Position = vec4(fibletRight ? fibletRectangle.z : fibletRectangle.x,
                     fibletUpper ? fibletRectangle.w : fibletRectangle.y, 0.0, 1.0);

//@ fragment after //VTK::CustomUniforms::Dec
uniform usampler2D fibletDepthMap;
uniform usampler2D fibletIdMap;
uniform ivec2 fibletOrigin;        // lower left pixel of the viewport
uniform ivec2 fibletSize;          // its size in pixels; 0: draw nothing
uniform mat4 fibletPixelToView;    // (x, y in [-1, 1], 1 - depth, 1) -> view coordinates, homogeneous
uniform mat3 fibletDataToView;     // directions: data -> view coordinates

const uint fibletEmpty = 0xFFFFFFFFu;

// Inverse of the octahedral map about +x; see the record's direction word.
vec3 fibletDirection(uint word)
{
  ivec2 s = ivec2(int(word << 16) >> 16, int(word) >> 16);
  vec2 p = vec2(s) / 32767.0;
  float x = 1.0 - abs(p.x) - abs(p.y);
  if (abs(s.x) + abs(s.y) > 32767)
  {
    p = (1.0 - abs(p.yx)) * vec2(s.x < 0 ? -1.0 : 1.0, s.y < 0 ? -1.0 : 1.0);
  }
  return normalize(vec3(x, p));
}

//@ fragment instead //VTK::PositionVC::Impl
  ivec2 fibletPixel = ivec2(gl_FragCoord.xy) - fibletOrigin;
  uint fibletKey = fibletSize.x > 0 ? texelFetch(fibletDepthMap, fibletPixel, 0).r : fibletEmpty;
//pvfiblets::Key::Impl
  if (fibletKey == fibletEmpty)
  {
    discard;
  }
  uvec2 fibletIds = texelFetch(fibletIdMap, fibletPixel, 0).rg;
//pvfiblets::Ids::Impl
  float fibletDepth = float(fibletKey) / 4294967295.0;
  vec3 fibletTangent = fibletDirection(fibletIds.y);
  vec2 fibletNDC = 2.0 * (vec2(fibletPixel) + 0.5) / vec2(fibletSize) - 1.0;
  float fibletFarness = float(fibletEmpty - fibletKey) / 4294967295.0;   // 1 - depth
  vec4 vertexVC = fibletPixelToView * vec4(fibletNDC, fibletFarness, 1.0);
  vertexVC /= vertexVC.w;

//@ fragment before //VTK::Depth::Impl
  gl_FragDepth = fibletDepth;

// VTK takes derivatives here, of the position for a normal and of the depth for coincident topology.
// Fiblets bring their normal, and neighbouring pixels may show other lines: there is no slope.
//@ fragment instead //VTK::UniformFlow::Impl
  const float cscale = 0.0;

// VTK's own clip code tests varyings of the covering triangle, which mean nothing here. The engine has cut the fiblets
// at the mapper's planes already, before it kept the nearest, so that the lines behind a cut are in the G-buffer.
//@ vertex instead //VTK::Clip::Dec
//@ vertex instead //VTK::Clip::Impl
//@ fragment instead //VTK::Clip::Dec
//@ fragment instead //VTK::Clip::Impl
