// Depth cueing: the farther from the viewer's plane, the nearer to one colour, from a near to a far distance.

//@ fragment after //VTK::CustomUniforms::Dec
uniform vec3 fibletCueLower;       // colour at the lower edge of the viewport, and at the upper
uniform vec3 fibletCueUpper;
uniform vec3 fibletCue;            // near, 1 / (far - near) (1/mm), strength at far

//@ fragment after //VTK::Light::Impl
  float fibletCued = fibletCue.z * clamp((-vertexVC.z - fibletCue.x) * fibletCue.y, 0.0, 1.0);
  gl_FragData[0].rgb = mix(gl_FragData[0].rgb,
    mix(fibletCueLower, fibletCueUpper, 0.5 * fibletNDC.y + 0.5), fibletCued);
