// The metallic-roughness BRDF of glTF 2.0, appendix B: Lambert, and GGX with height-correlated Smith
// visibility and Schlick's Fresnel. Nothing here calls pow: these run once a light.
#ifndef ATLASWIRE_SHADERS_BRDF_GLSL
#define ATLASWIRE_SHADERS_BRDF_GLSL

const float kPi = 3.14159265358979;

// A surface point as lights see it.
struct Reflectance {
  vec3 diffuse;   // albedo of the diffuse part, over pi
  vec3 specular;  // reflectance at normal incidence
  float alpha;    // GGX: roughness squared
  float alpha2;
  float n_dot_v;
};

Reflectance make_reflectance(vec3 base_color, float metallic, float roughness, float n_dot_v) {
  float alpha = max(roughness * roughness, 0.002);
  return Reflectance(base_color * ((1.0 - metallic) / kPi), mix(vec3(0.04), base_color, metallic), alpha,
                     alpha * alpha, n_dot_v);
}

// Radiance towards the viewer for unit irradiance perpendicular to `to_light`, cosine included; `n_dot_l` >= 0.
// The half vector h is never made: with m = |l + v|^2 = 2 + 2 l.v, (n.h)^2 = (n.l + n.v)^2 / m and
// (v.h)^2 = m / 4. Smith's height-correlated visibility in Hammon's form (2017), 0.5 / mix(2 nl nv, nl + nv,
// alpha), needs no root. Roots and divisions are what lights cost on a CPU.
vec3 reflect_light(Reflectance surface, vec3 to_viewer, vec3 to_light, float n_dot_l) {
  float m = max(2.0 + 2.0 * dot(to_light, to_viewer), 1e-4);
  float facing = n_dot_l + surface.n_dot_v;
  // The distribution's denominator, times m.
  float spread = min(facing * facing, m) * (surface.alpha2 - 1.0) + m;
  float visibility = mix(2.0 * n_dot_l * surface.n_dot_v, facing, surface.alpha);
  float lobe = 0.5 / kPi * surface.alpha2 * m * m / max(spread * spread * visibility, 1e-12);

  float grazing = 1.0 - 0.5 * sqrt(m);
  float grazing2 = grazing * grazing;
  float schlick = grazing2 * grazing2 * grazing;
  vec3 fresnel = surface.specular + (vec3(1.0) - surface.specular) * schlick;
  return (surface.diffuse * (vec3(1.0) - fresnel) + fresnel * lobe) * n_dot_l;
}

#endif
