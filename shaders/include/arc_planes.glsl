// planes
