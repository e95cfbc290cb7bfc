// Layers of a picture, one behind the other: of the next lines (layers.glsl), or of slices (slices.glsl).
//
// VTK's geometry holds two triangles for each layer. The first are drawn first, and are the farthest: a translucent actor is
// blended in this order. With depth peeling VTK sorts them itself, among whatever else is translucent. Layer 0 is the picture
// that is there anyway.

//@ vertex after //VTK::CustomUniforms::Dec
uniform int fibletLayerCount;      // layers to be drawn; the geometry may have more
flat out int fibletLayer;

//@ vertex after //VTK::PositionVC::Impl
  int fibletCorner = gl_VertexID % 6;
  fibletLayer = fibletLayerCount - 1 - gl_VertexID / 6;
  fibletRight = fibletCorner == 1 || fibletCorner == 3 || fibletCorner == 5;
  fibletUpper = fibletCorner >= 2 && fibletCorner <= 4;
  gl_Position = fibletLayer < 0 ? vec4(2.0, 2.0, 2.0, 1.0) :
                vec4(fibletRight ? fibletRectangle.z : fibletRectangle.x,
                     fibletUpper ? fibletRectangle.w : fibletRectangle.y, 0.0, 1.0);

//@ fragment after //VTK::CustomUniforms::Dec
flat in int fibletLayer;
