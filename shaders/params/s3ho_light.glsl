PARAMS(s3ho_light_params) {
    vec4 world_from_camera[3]; // rows
    vec4 bands;                // A_0, A_1, A_2, A_3, low-pass included
    vec4 light[16];            // rgb L_lm
} END_PARAMS(s3ho_light_params)
