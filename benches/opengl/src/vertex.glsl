#version 330 core

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;

uniform mat4 model;
uniform mat4 view_projection;
uniform vec3 light_position;
uniform vec3 light_intensity;
uniform vec3 base_colour;

out vec3 colour;

void main() {
    vec3 p = (model * vec4(position, 1.0)).xyz;
    vec3 n = normalize(mat3(model) * normal);
    vec3 to_light = light_position - p;
    float cosine = max(dot(n, normalize(to_light)), 0.0);
    colour = base_colour * light_intensity * cosine / dot(to_light, to_light);
    gl_Position = view_projection * vec4(p, 1.0);
}
