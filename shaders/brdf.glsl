// The metallic-roughness BRDF of glTF 2.0, appendix B: Lambert, and GGX with height-correlated Smith
// visibility and Schlick's Fresnel. Nothing here calls pow: these run once a light.
#ifndef ATLASWIRE_SHADERS_BRDF_GLSL
#define ATLASWIRE_SHADERS_BRDF_GLSL

const float kPi = 3.14159265358979;

// A surface point as lights see it.
struct Reflectance {
  vec3 diffuse;   // albedo of the diffuse part, over pi
  vec3 specular;  // reflectance at normal incidence
  float alpha2;   // GGX alpha squared
  float n_dot_v;
};

Reflectance make_reflectance(vec3 base_color, float metallic, float roughness, float n_dot_v) {
  float alpha = max(roughness * roughness, 0.002);
  return Reflectance(base_color * ((1.0 - metallic) / kPi), mix(vec3(0.04), base_color, metallic), alpha * alpha,
                     n_dot_v);
}

// Radiance towards the viewer for unit irradiance perpendicular to `to_light`, cosine included; `n_dot_l` > 0.
vec3 reflect_light(Reflectance surface, vec3 normal, vec3 to_viewer, vec3 to_light, float n_dot_l) {
  vec3 between = to_light + to_viewer;
  between *= inversesqrt(max(dot(between, between), 1e-8));
  float n_dot_h = clamp(dot(normal, between), 0.0, 1.0);
  float v_dot_h = clamp(dot(to_viewer, between), 0.0, 1.0);

  float spread = n_dot_h * n_dot_h * (surface.alpha2 - 1.0) + 1.0;
  float facing_v = n_dot_l * sqrt(surface.n_dot_v * surface.n_dot_v * (1.0 - surface.alpha2) + surface.alpha2);
  float facing_l = surface.n_dot_v * sqrt(n_dot_l * n_dot_l * (1.0 - surface.alpha2) + surface.alpha2);
  // Distribution alpha2 / (pi spread^2) times visibility 0.5 / (facing_v + facing_l).
  float lobe = surface.alpha2 * 0.5 / (kPi * spread * spread * (facing_v + facing_l));

  float grazing = 1.0 - v_dot_h;
  float grazing2 = grazing * grazing;
  float schlick = grazing2 * grazing2 * grazing;
  vec3 fresnel = surface.specular + (vec3(1.0) - surface.specular) * schlick;
  return (surface.diffuse * (vec3(1.0) - fresnel) + fresnel * lobe) * n_dot_l;
}

#endif
