// Directions that leave the frame (README, Outside). Where the march has met nothing, a direction is open if the picture shows that it
// passes through an opening. Of the others the share `openness` is taken to be open. What closes the rest sends the frame's mean light.

float open_share(uvec2 open, uvec2 seen) {
    float known = sector_share(open & seen);
    return known + params.openness * (sector_share(open) - known);
}
